// SPDX-License-Identifier: GPL-2.0-or-later
// Where relaxation ends: the exact static state without friction, a static equilibrium within the
// cone with it, an error when it takes too long.
#include "stepping/step_control.h"

#include "block_rig.h"
#include "plane.h"

static const double PRESSURE = 0.003;

static StepControlDef control_def(void)
{
    return (StepControlDef){.tolerance = 1e-6,
                            .step_max = 50,
                            .step_min = 1e-4,
                            .wave_step = 0.1,
                            .use_certificate = true};
}

static int64_t relax_rig(const RigDef *def, double speed_max, BlockRig *rig, StepControl *control)
{
    Error err = {0};
    int64_t steps = 0;
    StepControlDef steps_def = control_def();
    rig_build(def, rig);
    assert_true(step_control_create(&rig->block, &steps_def, control, &err));
    RelaxationDef relaxation = {.speed_max = speed_max, .duration_max = 1e5};
    if (!relax(control, &relaxation, &steps, &err)) fail_msg("%s", err.message);
    assert_int_equal(steps, control->counters.accepted);
    assert_true(dense_max_abs(control->now.slip_rate, rig->interface.count) <= speed_max);
    return steps;
}

// s_zz = -P on any mesh: r = P w, u_z = -P z / E, u_x = nu P (x - middle) / E.
TEST(test_frictionless_is_exact)
{
    const ElementKind kinds[] = {ELEMENT_Q4, ELEMENT_T6, ELEMENT_Q8};
    for (int32_t k = 0; k < 3; k++) {
        RigDef def = rig_def();
        def.block.kind = kinds[k];
        def.block.distortion = 0.2;
        def.law = (FrictionLaw){.kind = FRICTION_COULOMB, .mu_static = 0};
        BlockRig rig;
        StepControl control;
        relax_rig(&def, 1e-14, &rig, &control);
        double normal = 0, moment = 0, middle = 0, area = 0;
        for (int32_t i = 0; i < rig.interface.contact_count; i++) {
            double r = control.now.reaction[plane_normal(i)];
            normal += r;
            moment += r * rig.interface.x[i];
            assert_near("pressure", r / rig.interface.weight[i], PRESSURE, 1e-9 * PRESSURE);
            assert_near("shear", control.now.reaction[plane_tangent(i)], 0, 1e-11 * PRESSURE);
        }
        assert_near("resultant", normal, PRESSURE, 1e-10 * PRESSURE);
        assert_near("moment", moment, PRESSURE / 2, 1e-9 * PRESSURE);
        for (int32_t node = 0; node < rig.mesh.node_count; node++) {
            middle += rig.bulk.mass[2 * node] * rig.mesh.position[2 * node];
            area += rig.bulk.mass[2 * node];
        }
        middle /= area;   // of the lumped mass, which friction did not hold
        for (int32_t node = 0; node < rig.mesh.node_count; node++) {
            const double *at = rig.mesh.position + 2 * node;
            const double *u = control.now.displacement + 2 * node;
            assert_near("u_x", u[0], 0.34 * PRESSURE * (at[0] - middle), 1e-9 * PRESSURE);
            assert_near("u_z", u[1], -PRESSURE * at[1], 1e-9 * PRESSURE);
        }
        step_control_destroy(&control);
        rig_destroy(&rig);
    }
}

// With friction, dragged by half of what it holds: K u = f + r, r in the cone, resultants right,
// and nothing is left of the viscous and inertial parts.
TEST(test_friction_holds)
{
    RigDef def = rig_def();
    def.block.nx = 8;
    def.block.nz = 4;
    def.traction[0] = 0.05 * PRESSURE;
    BlockRig rig;
    StepControl control;
    relax_rig(&def, 1e-13, &rig, &control);
    const State *now = &control.now;
    int32_t n = rig.bulk.dof_count;
    double *k_dense = rig_dense(&rig, rig.bulk.stiffness), *force = hand_matrix(n, 1);
    hand_apply(k_dense, n, n, now->displacement, force);
    for (int32_t j = 0; j < rig.interface.count; j++)
        force[rig.interface.dofs[j]] -= now->reaction[j];
    assert_all_near("K u - r", force, rig.bulk.load, n, 1e-8);
    double normal = 0, shear = 0;
    for (int32_t i = 0; i < rig.interface.contact_count; i++) {
        double t = now->reaction[plane_tangent(i)], p = now->reaction[plane_normal(i)];
        assert_true(fabs(t) <= 0.38 * p * (1 + 1e-9));
        normal += p;
        shear += t;
    }
    assert_near("normal", normal, PRESSURE, 1e-9 * PRESSURE);
    assert_near("shear", shear, -0.05 * PRESSURE, 1e-9 * PRESSURE);
    free(k_dense);
    free(force);
    step_control_destroy(&control);
    rig_destroy(&rig);
}

// A block that is dragged away never settles.
TEST(test_too_long)
{
    Error err = {0};
    int64_t steps = 0;
    RigDef def = rig_def();
    def.law = (FrictionLaw){.kind = FRICTION_COULOMB, .mu_static = 0.1};
    def.rod_width = 0;
    def.block.height = 0.1;
    def.traction[0] = 0.2 * PRESSURE;
    BlockRig rig;
    StepControl control;
    StepControlDef steps_def = control_def();
    rig_build(&def, &rig);
    assert_true(step_control_create(&rig.block, &steps_def, &control, &err));
    RelaxationDef relaxation = {.speed_max = 1e-12, .duration_max = 30};
    assert_false(relax(&control, &relaxation, &steps, &err));
    assert_int_equal(err.code, ERROR_COMPUTE);
    assert_non_null(strstr(err.message, "while relaxing before the rod moves"));
    assert_non_null(strstr(err.message, "start.tolerance asks for 1e-12"));
    assert_true(control.now.time > 30 && control.now.time < 100);
    step_control_destroy(&control);
    rig_destroy(&rig);
}
