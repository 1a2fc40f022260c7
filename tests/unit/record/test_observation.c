// SPDX-License-Identifier: GPL-2.0-or-later
// Values that are read off a state, against sums over the mesh done here.
#include "record/observation.h"

#include "block_rig.h"
#include "own_laws.h"
#include "plane.h"
#include "seen_by_hand.h"

#include <math.h>

// Some steps of a pushed block; then the state and everything around it is known.
TEST(test_sums_over_the_mesh)
{
    Error err = {0};
    RigDef def = rig_def();
    def.rod_kind = ROD_PUSHES;
    def.rod_velocity = 1e-4;
    def.rod_width = 0.3;
    def.block.nz = 4;
    StepControlDef steps = {.tolerance = 1e-5,
                            .step_max = 0.5,
                            .step_min = 1e-6,
                            .wave_step = 0.1,
                            .use_certificate = true};
    ObservationScales scales = {.load = 0.003, .length = 1, .time = 3, .slip_velocity = 1e-4};
    BlockRig rig;
    StepControl control;
    rig_build(&def, &rig);
    assert_true(step_control_create(&rig.block, &steps, &control, &err));
    Observation seen = observe(&control, &scales);
    assert_true(seen.t == 0 && seen.step_size == 0 && seen.mu == 0 && seen.contact_error == 0);
    double moved = 0;
    for (int32_t s = 0; s < 300; s++) {
        assert_true(step_control_advance(&control, INFINITY, &err));
        const State *now = &control.now;
        seen = observe(&control, &scales);
        double normal = 0, rod = 0, fastest = 0, front = 0, forces = 0, inertia = 0;
        bool together = true;
        for (int32_t i = 0; i < rig.interface.contact_count; i++) {
            double r_n = now->reaction[plane_normal(i)];
            normal += r_n;
            forces += rig.interface.x[i] * r_n;
            fastest = fmax(fastest, fabs(now->velocity[2 * rig.interface.node[i]]));
            together = together && now->status[i] != CONTACT_STICK;
            if (together) front = rig.interface.x[i];
        }
        for (int32_t j = 0; j < rig.interface.rod_count; j++) {
            double r = now->reaction[interface_rod(&rig.interface, j)];
            rod += r;
            forces -= rig.interface.rod_z[j] * r;
        }
        for (int32_t node = 0; node < rig.mesh.node_count; node++) {
            const double *at = rig.mesh.position + 2 * node, *f = rig.bulk.load + 2 * node;
            const double *a = now->inertia + 2 * node;
            forces += at[0] * f[1] - at[1] * f[0];
            inertia += at[0] * a[1] - at[1] * a[0];
        }
        assert_near("t", seen.t, now->time, 0);
        assert_near("U", seen.U, 1e-4 * now->time, 1e-18);
        assert_near("F_T", seen.rod_force, rod, 1e-18);
        assert_near("p", seen.normal_force, normal, 1e-18);
        assert_near("mu", seen.mu, rod / 0.003, 1e-13);
        assert_near("fastest", seen.max_slip_rate, fastest, 1e-18);
        assert_near("front", seen.front, front, 0);
        assert_near("step", seen.step_size, control.last_step, 0);
        assert_near("forces", seen.moment_static_error, fabs(forces) / 0.003, 1e-12);
        assert_near("moments", seen.moment_error, fabs(forces - inertia) / 0.003, 1e-12);
        assert_true(seen.moment_error < 1e-11);
        assert_true(seen.contact_error < 1e-8 && seen.equation_error < 1e-11);
        assert_near("energy", seen.energy_error * energy_turnover(&control.ledger),
                    fabs(energy_imbalance(&control.ledger)), 1e-20);
        assert_int_equal(seen.certified, control.certified);
        moved = fmax(moved, seen.moment_static_error);
    }
    assert_true(moved > 1e-3);   // inertia had a part in it

    // A reaction that no condition allows shows in every measure it should.
    control.now.reaction[plane_normal(2)] -= 0.003;
    seen = observe(&control, &scales);
    assert_true(seen.contact_error > 0.1);
    assert_near("moment", seen.moment_error, rig.interface.x[2], 1e-10);
    step_control_destroy(&control);
    rig_destroy(&rig);
}

// Slow slip counts as stick where the own law of the node creeps, whichever law drops most.
TEST(test_slow_slip_of_two_laws)
{
    Error err = {0};
    RigDef def = rig_def();
    StepControlDef steps = {.tolerance = 1e-5, .step_max = 0.5, .step_min = 1e-6, .wave_step = 0.1};
    ObservationScales scales = {.load = 0.003, .length = 1, .time = 3, .slip_velocity = 1e-4};
    BlockRig rig;
    StepControl control;
    rig_build(&def, &rig);
    assert_true(step_control_create(&rig.block, &steps, &control, &err));
    for (int k = 0; k < 2; k++) {
        FrictionLaw laws[] = {
            {.mu_static = k ? 0.9 : 0.1001, .mu_kinetic = 0.1, .critical_velocity = 1e-3},
            law_with_state((FrictionLaw){.kind = FRICTION_RATE_STATE,
                                         .slip_distance = 1e-4,
                                         .evolution_effect = 0.015,
                                         .direct_effect = 0.01,
                                         .mu_reference = 0.3,
                                         .reference_velocity = 1e-4})};
        FrictionNode nodes[64];
        int32_t count = rig.interface.contact_count;
        assert_true(count <= 64);
        for (int32_t i = 0; i < count; i++) {
            nodes[i] = friction_node(&laws[i % 2], 1);
            control.now.status[i] = CONTACT_SLIP_FORWARD;
            control.now.slip_rate[plane_tangent(i)] = i % 4 < 2 ? 1e-7 : 1e-4;
        }
        Friction friction = friction_of_nodes(nodes, count);
        assert_int_equal(friction.whole.law->creeps, k == 0);
        control.scheme.friction = &friction;
        Observation seen = observe(&control, &scales);
        for (int32_t i = 0; i < count; i++)
            assert_int_equal(seen_status(&seen, i),
                             i % 4 == 1 ? CONTACT_STICK : CONTACT_SLIP_FORWARD);
    }
    step_control_destroy(&control);
    rig_destroy(&rig);
}

// --- which steps a window hands on, by U and by time --------------------------------------------

enum { STEPS = 10 };

typedef struct Rig {
    HandSeen hand;
    Window window;
    int32_t inside[STEPS], inside_count;
} Rig;

static bool note_inside(void *self, const Observation *seen, Error *err)
{
    (void)err;
    Rig *rig = self;
    rig->inside[rig->inside_count++] = (int32_t)lround(seen->t);
    return true;
}

// Steps 0 to 9; U is a tenth of the time.
static void expect_inside(WindowDef def, int32_t first, int32_t last)
{
    Rig rig = {0};
    Error err = {0};
    hand_seen_init(&rig.hand);
    if (def.to_U == 0) def.to_U = INFINITY;
    if (def.to_t == 0) def.to_t = INFINITY;
    rig.window.def = def;
    recorders_add(&rig.window.inside, &rig, note_inside);
    for (int32_t t = 0; t < STEPS; t++) {
        rig.hand.seen.t = t;
        rig.hand.seen.U = 0.1 * t;
        assert_true(window_record(&rig.window, &rig.hand.seen, &err));
    }
    assert_int_equal(rig.inside_count, last - first + 1);
    for (int32_t k = 0; k < rig.inside_count; k++) assert_int_equal(rig.inside[k], first + k);
    assert_int_equal(rig.window.steps, rig.inside_count);
}

TEST(test_from_one_place_to_another)
{
    expect_inside((WindowDef){.from_U = 0.25, .to_U = 0.65}, 3, 6);
    expect_inside((WindowDef){.from_t = 4, .to_t = 8}, 4, 8);
    expect_inside((WindowDef){.from_U = 0.5}, 5, 9);
}
