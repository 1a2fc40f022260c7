// SPDX-License-Identifier: GPL-2.0-or-later
// The integrator against a Runge-Kutta solution of the dense equations written out here, its
// estimate against its own local error, and the balances of momentum and energy.
#include "stepping/sdirk.h"

#include "plane.h"
#include "stepper.h"

// M a = f - C v - K u with the contact normals held at 0.
typedef struct Reference {
    int32_t n;
    double *k, *c;
    double *u, *v;   // [n]
    const Bulk *bulk;
    const Interface *interface;
} Reference;

static void reference_rate(const Reference *ref, const double *u, const double *v, double *a)
{
    double *damped = hand_matrix(ref->n, 1);
    hand_apply(ref->k, ref->n, ref->n, u, a);
    hand_apply(ref->c, ref->n, ref->n, v, damped);
    for (int32_t i = 0; i < ref->n; i++)
        a[i] = (ref->bulk->load[i] - a[i] - damped[i]) / ref->bulk->mass[i];
    for (int32_t i = 0; i < ref->interface->contact_count; i++)
        a[ref->interface->dofs[plane_normal(i)]] = 0;
    free(damped);
}

static Reference reference_create(const BlockRig *rig)
{
    Reference ref = {.n = rig->bulk.dof_count, .bulk = &rig->bulk, .interface = &rig->interface};
    ref.k = rig_dense(rig, rig->bulk.stiffness);
    ref.c = rig_dense(rig, rig->bulk.damping);
    ref.u = hand_matrix(ref.n, 1);
    ref.v = hand_matrix(ref.n, 1);
    return ref;
}

static void reference_destroy(Reference *ref)
{
    free(ref->k);
    free(ref->c);
    free(ref->u);
    free(ref->v);
}

// The classical fourth-order scheme, `steps` steps.
static void reference_run(Reference *ref, double duration, int32_t steps)
{
    static const double nodes[] = {0, 0.5, 0.5, 1}, weights[] = {1. / 6, 1. / 3, 1. / 3, 1. / 6};
    int32_t n = ref->n;
    double dt = duration / steps;
    double *u = hand_matrix(n, 1), *v = hand_matrix(n, 1), *rate = hand_matrix(n, 2);
    double *sum = hand_matrix(n, 2);
    for (int32_t s = 0; s < steps; s++) {
        memset(sum, 0, 2 * (size_t)n * sizeof *sum);
        memset(rate, 0, 2 * (size_t)n * sizeof *rate);
        for (int stage = 0; stage < 4; stage++) {
            for (int32_t i = 0; i < n; i++) {
                u[i] = ref->u[i] + nodes[stage] * dt * rate[i];
                v[i] = ref->v[i] + nodes[stage] * dt * rate[n + i];
            }
            memcpy(rate, v, (size_t)n * sizeof *rate);
            reference_rate(ref, u, v, rate + n);
            for (int32_t i = 0; i < 2 * n; i++) sum[i] += weights[stage] * dt * rate[i];
        }
        for (int32_t i = 0; i < n; i++) {
            ref->u[i] += sum[i];
            ref->v[i] += sum[n + i];
        }
    }
    free(u);
    free(v);
    free(rate);
    free(sum);
}

static double largest_difference(const double *a, const double *b, int32_t n)
{
    double worst = 0;
    for (int32_t i = 0; i < n; i++) worst = fmax(worst, fabs(a[i] - b[i]));
    return worst;
}

// Observed at two refinements: u and v of each scheme, on a smooth motion.
TEST(test_order)
{
    RigDef def = smooth_def();
    Stepper stepper;
    double errors[3][2];
    for (int32_t k = 0; k < 3; k++) {
        stepper_build(&def, 0.1, &stepper);
        Reference ref = reference_create(&stepper.rig);
        reference_run(&ref, 1, 1000);
        for (int32_t s = 0; s < 10 << k; s++) {
            StepOutcome outcome = do_step(&stepper, k);
            assert_near("M a + C v + K u - f - r", outcome.residual, 0, 1e-15);
            for (int32_t i = 0; i < 4; i++) assert_true(stepper.now.status[i] != CONTACT_OPEN);
        }
        assert_near("t", stepper.now.time, 1, 1e-12);
        errors[k][0] = largest_difference(stepper.now.displacement, ref.u, ref.n);
        errors[k][1] = largest_difference(stepper.now.velocity, ref.v, ref.n);
        reference_destroy(&ref);
        stepper_destroy(&stepper);
    }
    for (int which = 0; which < 2; which++) {
        for (int k = 0; k < 2; k++)
            assert_near("order", log2(errors[k][which] / errors[k + 1][which]), 2,
                        k == 0 ? 0.05 : 0.03);
    }
    assert_true(errors[2][0] < 1e-4 * 3e-4);   // of the motion
}

// Where a node comes to stick or slip within a step, no scheme keeps its order; but it tends to one
// motion, of order 1 at least. A block that a bonded rod drags from rest, then slip weakens.
TEST(test_order_with_slip)
{
    RigDef def = rig_def();
    def.law = (FrictionLaw){.kind = FRICTION_LINEAR_WEAKENING,
                            .mu_static = 0.38,
                            .mu_kinetic = 0.1,
                            .critical_velocity = 0.05};
    def.rod_kind = ROD_IS_BONDED;
    def.rod_velocity = 2e-3;
    double *fine = NULL, error[3] = {0};
    int32_t slipping = 0, n = 0;
    for (int32_t k = 6; k >= 0; k -= 2) {   // 6: 640 steps, its own reference
        Stepper stepper;
        stepper_build(&def, 0.1, &stepper);
        n = stepper.now.dof_count;
        for (int32_t s = 0; s < 10 << k; s++) do_step(&stepper, k);
        for (int32_t i = 0; i < stepper.now.contact_count; i++)
            slipping += status_slips(stepper.now.status[i]);
        if (k == 6) {
            fine = hand_matrix(n, 1);
            memcpy(fine, stepper.now.displacement, (size_t)n * sizeof *fine);
        } else {
            error[k / 2] = largest_difference(stepper.now.displacement, fine, n);
        }
        stepper_destroy(&stepper);
    }
    assert_true(slipping > 0);
    assert_true(log2(error[0] / error[2]) > 4 * 0.9);   // over four halvings
    free(fine);
}

// One step of level k from a state that fine steps have smoothed: the estimate is what the step
// misses, of order 3.
TEST(test_estimate)
{
    RigDef def = smooth_def();
    Stepper stepper;
    double before = 0;
    for (int32_t k = 0; k < 3; k++) {
        stepper_build(&def, 0.02, &stepper);
        for (int32_t s = 0; s < 400; s++) do_step(&stepper, 6);
        Reference ref = reference_create(&stepper.rig);
        memcpy(ref.u, stepper.now.displacement, (size_t)ref.n * sizeof(double));
        memcpy(ref.v, stepper.now.velocity, (size_t)ref.n * sizeof(double));
        StepOutcome outcome = do_step(&stepper, k);
        reference_run(&ref, dt_level_step(&stepper.dt_levels, k), 200);
        double error = largest_difference(stepper.now.displacement, ref.u, ref.n);
        assert_near("estimate over error", outcome.error / error, 1, 0.12 / (1 << k));
        if (k > 0) assert_near("order", log2(before / outcome.error), 3, 0.3 / k);
        before = outcome.error;
        reference_destroy(&ref);
        stepper_destroy(&stepper);
    }
}

// The ledger's imbalance goes down with the square of the step.
TEST(test_energy_order)
{
    RigDef def = smooth_def();
    Stepper stepper;
    double missing[3];
    for (int32_t k = 0; k < 3; k++) {
        stepper_build(&def, 0.1, &stepper);
        for (int32_t s = 0; s < 400; s++) do_step(&stepper, 6);   // past the jump of the load
        EnergyLedger ledger = energy_open(&stepper.now);
        assert_near("nothing yet", energy_imbalance(&ledger), 0, 0);
        for (int32_t s = 0; s < 10 << k; s++) {
            StepOutcome outcome = do_step(&stepper, k);
            sdirk_add_energy(&stepper.scheme, &outcome, dt_level_step(&stepper.dt_levels, k),
                             &ledger);
        }
        energy_store(&stepper.now, &ledger);
        assert_true(ledger.viscous > 0 && ledger.rod_work == 0);
        assert_near("no friction", ledger.frictional, 0, 1e-12 * ledger.viscous);
        missing[k] = energy_imbalance(&ledger);
        stepper_destroy(&stepper);
    }
    assert_near("order", log2(missing[0] / missing[1]), 2, 0.1);
    assert_near("order", log2(missing[1] / missing[2]), 2, 0.05);
}

// The step's change of momentum, along x, along z and about the origin, is the impulse of loads and
// reactions with the stages' weights: to rounding, whatever sticks, slips or lifts off.
static void check_momentum(const RigDef *def, int32_t seen[4])
{
    Stepper stepper;
    stepper_build(def, 0.05, &stepper);
    const BlockRig *rig = &stepper.rig;
    for (int32_t s = 0; s < 200; s++) {
        double step = dt_level_step(&stepper.dt_levels, s % 3);
        do_step(&stepper, s % 3);
        const State *now = &stepper.now, *old = &stepper.next;   // swapped: the step's start
        double change[3] = {0}, impulse[3] = {0};
        for (int32_t node = 0; node < rig->mesh.node_count; node++) {
            const double *at = rig->mesh.position + 2 * node;
            double p[2], f[2];
            for (int d = 0; d < 2; d++) {
                int32_t dof = 2 * node + d;
                p[d] = rig->bulk.mass[dof] * (now->velocity[dof] - old->velocity[dof]);
                f[d] = step * rig->bulk.load[dof];
                change[d] += p[d];
                impulse[d] += f[d];
            }
            change[2] += at[0] * p[1] - at[1] * p[0];
            impulse[2] += at[0] * f[1] - at[1] * f[0];
        }
        for (int32_t j = 0; j < rig->interface.count; j++) {
            double r = step * ((1 - SDIRK2.gamma) * stepper.scheme.stage_reaction[j] +
                               SDIRK2.gamma * now->reaction[j]);
            int32_t dof = rig->interface.dofs[j];
            const double *at = rig->mesh.position + 2 * (dof / 2);
            impulse[dof % 2] += r;
            impulse[2] += dof % 2 ? at[0] * r : -at[1] * r;
        }
        // Rounding of K u: up to 1.1e-17 was seen, 8e-14 of the impulse.
        for (int d = 0; d < 3; d++) assert_near("momentum", change[d], impulse[d], 3e-17);
        for (int32_t i = 0; i < rig->interface.contact_count; i++) seen[now->status[i]]++;
    }
    stepper_destroy(&stepper);
}

TEST(test_momentum)
{
    RigDef def = rig_def();
    def.rod_kind = ROD_PUSHES;
    def.rod_velocity = 2e-3;
    int32_t seen[4] = {0};
    for (int32_t drag = -1; drag <= 1; drag++) {   // tipped back, pushed only, tipped forward
        def.traction[0] = 0.003 * drag;
        check_momentum(&def, seen);
    }
    assert_true(seen[CONTACT_STICK] > 0 && seen[CONTACT_SLIP_FORWARD] > 0 &&
                seen[CONTACT_SLIP_BACKWARD] > 0 && seen[CONTACT_OPEN] > 0);
}

// Dragged with more than friction holds, the whole block slides: every node carries mu p, and its
// momentum grows with the difference.
TEST(test_sliding_block)
{
    RigDef def = rig_def();
    def.law = (FrictionLaw){.kind = FRICTION_COULOMB, .mu_static = 0.2};
    def.rod_width = 0;
    def.block.height = 0.1;
    def.block.nz = 1;
    def.traction[0] = 0.3 * 0.003;
    Stepper stepper;
    stepper_build(&def, 0.02, &stepper);
    for (int32_t s = 0; s < 1000; s++) do_step(&stepper, 0);
    double momentum[2] = {0}, duration = 0;
    for (int32_t round = 0; round < 2; round++) {
        for (int32_t k = 0; k < stepper.rig.bulk.dof_count; k += 2)
            momentum[round] += stepper.now.momentum[k];
        if (round == 1) break;
        for (int32_t s = 0; s < 100; s++) do_step(&stepper, 0);
        duration = 100 * 0.02;
    }
    double shear = 0, normal = 0;
    for (int32_t i = 0; i < 5; i++) {
        assert_int_equal(stepper.now.status[i], CONTACT_SLIP_FORWARD);
        shear += stepper.now.reaction[plane_tangent(i)];
        normal += stepper.now.reaction[plane_normal(i)];
    }
    assert_near("weight carried", normal, 0.003, 1e-7);
    assert_near("friction", shear, -0.2 * normal, 1e-15);
    assert_near("thrust", (momentum[1] - momentum[0]) / duration, (0.3 - 0.2) * 0.003, 3e-9);
    stepper_destroy(&stepper);
}

// L-stability: one enormous step ends at rest in the static state, s_zz = -P everywhere.
TEST(test_enormous_step)
{
    RigDef def = smooth_def();
    def.traction[0] = 0;
    Stepper stepper;
    stepper_build(&def, 1e5, &stepper);
    for (int32_t s = 0; s < 2; s++) do_step(&stepper, 0);
    const Mesh *mesh = &stepper.rig.mesh;
    for (int32_t node = 0; node < mesh->node_count; node++) {
        double x = mesh->position[2 * node] - 0.5, z = mesh->position[2 * node + 1];
        const double *u = stepper.now.displacement + 2 * node, *v = stepper.now.velocity + 2 * node;
        assert_near("u_x", u[0], 0.34 * 0.003 * x, 1e-8);
        assert_near("u_z", u[1], -0.003 * z, 1e-8);
        assert_near("v_x", v[0], 0, 1e-11);
        assert_near("v_z", v[1], 0, 1e-11);
    }
    stepper_destroy(&stepper);
}

// The rod's nodes are where the rod is, to rounding, at the end of every step.
TEST(test_bonded_rod)
{
    RigDef def = rig_def();
    def.rod_kind = ROD_IS_BONDED;
    def.rod_velocity = 1e-3;
    Stepper stepper;
    stepper_build(&def, 0.05, &stepper);
    stepper.rig.rod.origin[0] = 0;
    int32_t dof = stepper.rig.interface.dofs[interface_rod(&stepper.rig.interface, 0)];
    double rod_work = 0, force = 0;
    for (int32_t s = 0; s < 40; s++) {
        StepOutcome outcome = do_step(&stepper, s % 4);
        double target = 1e-3 * stepper.now.time, step = dt_level_step(&stepper.dt_levels, s % 4);
        assert_near("u_x", stepper.now.displacement[dof], target, 1e-17);
        assert_int_equal(stepper.now.rod_touches[0], 1);
        EnergyLedger ledger = {0};
        sdirk_add_energy(&stepper.scheme, &outcome, step, &ledger);
        rod_work += ledger.rod_work;
        force += step * ((1 - SDIRK2.gamma) * stepper.scheme.stage_reaction[10] +
                         SDIRK2.gamma * stepper.now.reaction[10]);
        if (s == 0) rod_work = force = 0;   // the jump to V
    }
    // From the second step on both stages go at V: work is V times impulse.
    assert_near("rod work", rod_work, 1e-3 * force, 1e-4 * fabs(rod_work));
    stepper_destroy(&stepper);
}

TEST(test_unsolved_is_an_outcome)
{
    Error err = {0};
    RigDef def = rig_def();
    Stepper stepper;
    StepOutcome outcome;
    stepper_build(&def, 0.1, &stepper);
    stepper.now.momentum[0] = NAN;
    assert_true(sdirk_step(&stepper.scheme, 0, &stepper.now, &stepper.next, &outcome, &err));
    assert_false(outcome.solved);
    assert_true(error_is_clean(&err));
    assert_true(stepper.now.time == 0);
    stepper_destroy(&stepper);
}

TEST(test_memory_faults)
{
    RigDef def = rig_def();
    BlockRig rig;
    rig_build(&def, &rig);
    int64_t live = memory_counters().live;
    bool done = false;
    for (int32_t k = 0; !done; k++) {
        Error err = {0};
        DtLevels dt_levels;
        Sdirk scheme = {0};
        State now = {0};
        dt_levels_init(&rig.system, 1, 0.1, &dt_levels);
        memory_fail_after(k);
        done = sdirk_create(&rig.block, &dt_levels, &scheme, &err) &&
               state_create(&rig.system, &rig.interface, &now, &err) &&
               dt_level_operator(&dt_levels, 1, PART_WHOLE, &err) != NULL;
        memory_fail_after(-1);
        assert_int_equal(err.code, done ? ERROR_NONE : ERROR_MEMORY);
        state_destroy(&now);
        sdirk_destroy(&scheme);
        dt_levels_destroy(&dt_levels);
        assert_int_equal(memory_counters().live, live);
    }
    rig_destroy(&rig);
}
