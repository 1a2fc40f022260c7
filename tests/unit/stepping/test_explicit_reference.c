// SPDX-License-Identifier: GPL-2.0-or-later
// The explicit reference against the implicit scheme (another method for the same equations),
// against a rigid sled's exact stop, and against the judge of contact, which knows no solver.
#include "stepping/explicit_reference.h"

#include "contact/contact_check.h"
#include "own_laws.h"
#include "stepped_block.h"
#include "stepping/stable_step.h"
#include "stepping/step_control.h"

typedef struct Run {
    ExplicitReference scheme;
    EnergyLedger ledger;
} Run;

static void run_start(SteppedBlock *block, double step, Run *run)
{
    Error err = {0};
    ExplicitDef def = {.bulk = &block->bulk,
                       .interface = &block->interface,
                       .friction = &block->friction,
                       .rod = &block->rod,
                       .step = step};
    assert_true(explicit_reference_create(&def, &run->scheme, &err));
    explicit_reference_start(&run->scheme, &block->state);
    run->ledger = energy_open(&block->state);
}

static void run_advance(SteppedBlock *block, int64_t steps, Run *run)
{
    Error err = {0};
    if (!explicit_reference_advance(&run->scheme, steps, &block->state, &run->ledger, &err))
        fail_msg("%s", err.message);
}

static double energy_error(const EnergyLedger *ledger)
{
    return fabs(energy_imbalance(ledger)) / energy_turnover(ledger);
}

static double judge(const SteppedBlock *block, const Run *run)
{
    ContactProblem problem = {.interface = &block->interface,
                              .friction = &block->friction,
                              .rod_kind = block->rod.kind,
                              .bound = run->scheme.bound};
    ContactResidual residual =
        contact_residual(&problem, block->state.slip_rate, block->state.reaction, 1e-4, 1e-3);
    return contact_residual_max(&residual);
}

// --- smooth: order
// -------------------------------------------------------------------------------- A bonded rod
// sets a frictionless block moving; nothing opens.
static SteppedDef smooth_block(double eta)
{
    return (SteppedDef){.cells = 4,
                        .pressure = 0.01,
                        .eta = eta,
                        .law = {.kind = FRICTION_COULOMB},
                        .rod_kind = ROD_IS_BONDED,
                        .rod_velocity = 1e-3};
}

enum { SMOOTH_STEPS_IMPLICIT = 4096 };
static const double SMOOTH_TIME = 1.0;

// The smooth block at half of SMOOTH_TIME and u at all of it [dof_count], by SDIRK2 in equal steps.
static void implicit_smooth(const SteppedDef *def, SteppedBlock *half, double *wanted)
{
    Error err = {0};
    stepped_block_build(def, half);
    Block parts = {.system = &half->system,
                   .interface = &half->interface,
                   .friction = &half->friction,
                   .rod = &half->rod};
    double step = SMOOTH_TIME / SMOOTH_STEPS_IMPLICIT;
    StepControlDef control_def = {.tolerance = 1,
                                  .step_max = step,
                                  .step_min = step / 2,
                                  .wave_step = step,
                                  .use_certificate = false};
    StepControl control;
    assert_true(step_control_create(&parts, &control_def, &control, &err));
    state_copy(&half->state, &control.now);
    step_control_restart(&control);
    while (control.counters.accepted < SMOOTH_STEPS_IMPLICIT) {
        assert_true(step_control_advance(&control, INFINITY, &err));
        if (2 * control.counters.accepted == SMOOTH_STEPS_IMPLICIT)
            state_copy(&control.now, &half->state);
    }
    assert_near("time", control.now.time, SMOOTH_TIME, 1e-10);
    memcpy(wanted, control.now.displacement, (size_t)half->state.dof_count * sizeof(double));
    step_control_destroy(&control);
}

// The largest difference of u from `wanted` after `steps` steps from the block's state to
// SMOOTH_TIME, over the rod's way.
static double smooth_error(SteppedBlock *block, int64_t steps, const double *wanted,
                           double *unbalanced)
{
    Run run;
    double worst = 0;
    run_start(block, (SMOOTH_TIME - block->state.time) / (double)steps, &run);
    run_advance(block, steps, &run);
    assert_near("time", block->state.time, SMOOTH_TIME, 1e-12);
    for (int32_t k = 0; k < block->state.dof_count; k++)
        worst = fmax(worst, fabs(block->state.displacement[k] - wanted[k]));
    *unbalanced = energy_error(&run.ledger);
    explicit_reference_destroy(&run.scheme);
    return worst / (block->rod.velocity * SMOOTH_TIME);
}

// From rest, and from the implicit scheme's state on the way.
static void check_order_of(SteppedDef def, int64_t steps, double order, double error_wanted)
{
    SteppedBlock half;
    double wanted[2 * 25], unbalanced[3], errors[3];
    implicit_smooth(&def, &half, wanted);
    for (int32_t from_rest = 0; from_rest < 2; from_rest++) {
        for (int32_t k = 0; k < 3; k++) {
            SteppedBlock block;
            stepped_block_build(&def, &block);
            if (!from_rest) state_copy(&half.state, &block.state);
            errors[k] = smooth_error(&block, steps << k, wanted, &unbalanced[k]);
            stepped_block_destroy(&block);
        }
        assert_near("order", log2(errors[0] / errors[1]), order, 0.15);
        assert_near("order", log2(errors[1] / errors[2]), order, 0.15);
        assert_true(errors[0] < error_wanted);
        // Though the rod hits standing nodes at the start: what that takes is in the ledger.
        assert_near("order of the ledger", log2(unbalanced[1] / unbalanced[2]), 1, 0.2);
    }
    stepped_block_destroy(&half);
}

static void check_order(double eta, int64_t steps, double order, double error_wanted)
{
    check_order_of(smooth_block(eta), steps, order, error_wanted);
}

TEST(test_order_elastic)
{
    check_order(0, 64, 2, 1e-2);
}

// Branches of times within, and far longer than, what is run: the scheme keeps its order, and the
// implicit one, which eliminates them, has the same motion.
TEST(test_order_of_branches)
{
    SteppedDef def = smooth_block(0);
    def.branch_count = 2;
    def.branch[0] = (Branch){.time = 0.2, .shear = 0.4, .bulk = 0.3};
    def.branch[1] = (Branch){.time = 30, .shear = 0.2};
    check_order_of(def, 96, 2, 1e-2);
}

// Viscous forces lag: order 1, but with steps this short as good.
TEST(test_order_viscous)
{
    check_order(1, 512, 1, 1e-2);
}

// --- contact and friction
// --------------------------------------------------------------------------- A block that slides
// as a whole under Coulomb friction is slowed by mu P L / m whatever waves run in it, so its centre
// stops at v0 / a, after v0^2 / 2 a, and then stays.
static void check_sled_stops(FrictionLaw law, double mu)
{
    Error err = {0};
    const double pressure = 0.001, v0 = 0.02;
    SteppedDef def = {.cells = 4, .pressure = pressure, .eta = 1, .law = law, .rod_kind = ROD_AWAY};
    SteppedBlock block;
    Run run;
    double step = 0, mass = STEPPED_LENGTH * STEPPED_HEIGHT, start = 0, centre = 0;
    double slowing = mu * pressure * STEPPED_LENGTH / mass;
    stepped_block_build(&def, &block);
    for (int32_t k = 0; k < block.state.dof_count; k += 2) {
        block.state.velocity[k] = v0;
        start += block.bulk.mass[k] * block.state.displacement[k] / mass;
    }
    bulk_operator_apply(&block.system, BULK_MASS, block.state.velocity, block.state.momentum);
    assert_true(stable_step(&block.bulk, &step, &err));
    run_start(&block, step, &run);
    for (int32_t k = 0; k < 200; k++) {   // past v0 / slowing
        run_advance(&block, (int64_t)(0.02 * v0 / slowing / step), &run);
        assert_true(judge(&block, &run) < 1e-9);
    }
    for (int32_t k = 0; k < block.state.dof_count; k += 2)
        centre += block.bulk.mass[k] * block.state.displacement[k] / mass;
    assert_near("way", centre - start, v0 * v0 / 2 / slowing, 0.003 * v0 * v0 / 2 / slowing);
    for (int32_t i = 0; i < block.interface.contact_count; i++)
        assert_int_equal(block.state.status[i], CONTACT_STICK);
    assert_near("kinetic", run.ledger.kinetic, 0, 1e-6 * run.ledger.frictional);
    assert_true(energy_error(&run.ledger) < 1e-3);
    explicit_reference_destroy(&run.scheme);
    stepped_block_destroy(&block);
}

// By Coulomb's law, by a formula that says the same (of such a law it is not known that it is
// convex), and by one that does so from 1e-8 on and falls to there faster than speed can.
TEST(test_sled_stops)
{
    check_sled_stops((FrictionLaw){.kind = FRICTION_COULOMB, .mu_static = 0.3}, 0.3);
    check_sled_stops(own_formula("0.3", 1), 0.3);
    check_sled_stops(own_formula("0.3 + 0.1 * exp(-v / 1e-9)", 1), 0.3);
}

// The same sled under a law that weakens and strengthens again: its speed is that of Heun's method
// for v' = -mu(v) P/(rho H). The block is soft, so its parts oscillate about the mean.
TEST(test_sled_of_own_law)
{
    Error err = {0};
    const double pressure = 0.001, mass = STEPPED_LENGTH * STEPPED_HEIGHT;
    SteppedDef def = {.cells = 4,
                      .pressure = pressure,
                      .eta = 1,
                      .law = own_formula("0.3 - 0.1 * tanh(v / 0.003) + 0.05 * tanh(v / 0.02)", 1),
                      .rod_kind = ROD_AWAY};
    SteppedBlock block;
    Run run;
    double step = 0, v = 0.02, time = 0, h = 1e-3;
    stepped_block_build(&def, &block);
    for (int32_t k = 0; k < block.state.dof_count; k += 2) block.state.velocity[k] = v;
    bulk_operator_apply(&block.system, BULK_MASS, block.state.velocity, block.state.momentum);
    assert_true(stable_step(&block.bulk, &step, &err));
    run_start(&block, step, &run);
    for (int32_t k = 0; k < 20; k++) {
        double momentum = 0;
        run_advance(&block, (int64_t)(1.5 / step), &run);
        assert_true(judge(&block, &run) < 1e-9);
        for (; time + h < block.state.time + 0.5 * h; time += h) {
            double slowing[2], at = v;
            for (int32_t s = 0; s < 2; s++) {
                double mu = 0.3 - 0.1 * tanh(at / 0.003) + 0.05 * tanh(at / 0.02);
                slowing[s] = mu * pressure * STEPPED_LENGTH / mass;
                at = v - h * slowing[0];
            }
            v -= 0.5 * h * (slowing[0] + slowing[1]);
        }
        for (int32_t i = 0; i < block.state.dof_count; i += 2)
            momentum += block.bulk.mass[i] * block.state.velocity[i];
        assert_near("v", momentum / mass, v, 0.004 * 0.02);
    }
    assert_true(v < 0.01);
    explicit_reference_destroy(&run.scheme);
    stepped_block_destroy(&block);
}

// Stick-slip with each law, pushed and bonded: every observed step keeps the conditions exactly,
// and all three statuses have been seen.
TEST(test_conditions)
{
    Error err = {0};
    const FrictionKind laws[] = {FRICTION_LINEAR_WEAKENING, FRICTION_EXPONENTIAL_WEAKENING,
                                 FRICTION_COULOMB};
    for (int32_t k = 0; k < 3; k++) {
        SteppedDef def = {.cells = 6,
                          .pressure = 0.003,
                          .eta = 1,
                          .law = {.kind = laws[k],
                                  .mu_static = 0.38,
                                  .mu_kinetic = 0.1,
                                  .critical_velocity = 3.4e-4},
                          .rod_kind = k == 2 ? ROD_IS_BONDED : ROD_PUSHES,
                          .rod_velocity = 1e-4};
        SteppedBlock block;
        Run run;
        double step = 0;
        int32_t slips = 0, sticks = 0;
        stepped_block_build(&def, &block);
        assert_true(stable_step(&block.bulk, &step, &err));
        run_start(&block, step, &run);
        int64_t allocations = memory_counters().allocations;
        for (int32_t row = 0; row < 400; row++) {
            run_advance(&block, 100, &run);
            assert_true(judge(&block, &run) < 1e-9);
            assert_true(run.scheme.residual < 1e-3 * def.pressure);
            for (int32_t i = 0; i < block.interface.contact_count; i++) {
                slips += status_slips(block.state.status[i]);
                sticks += block.state.status[i] == CONTACT_STICK;
            }
        }
        assert_int_equal(memory_counters().allocations, allocations);
        assert_near("time", block.state.time, 40000 * step, 1e-9);
        assert_true(slips > 100 && sticks > 100);
        assert_true(energy_error(&run.ledger) < 1e-3);
        explicit_reference_destroy(&run.scheme);
        stepped_block_destroy(&block);
    }
}

// A law so steep that both stick and slip hold: who sticks goes on sticking, who slips slipping.
TEST(test_both_hold)
{
    Error err = {0};
    for (int32_t slips = 0; slips < 2; slips++) {
        SteppedDef def = {.cells = 2,
                          .pressure = 0.01,
                          .eta = 0,
                          .law = {.kind = FRICTION_LINEAR_WEAKENING,
                                  .mu_static = 1e3,
                                  .mu_kinetic = 1e-3,
                                  .critical_velocity = 1e-6},
                          .rod_kind = ROD_AWAY};
        SteppedBlock block;
        Run run;
        double step = 0;
        stepped_block_build(&def, &block);
        for (int32_t k = 0; k < block.state.dof_count; k += 2) block.state.velocity[k] = 1e-3;
        if (slips)
            memset(block.state.status, CONTACT_SLIP_FORWARD, (size_t)block.state.contact_count);
        assert_true(stable_step(&block.bulk, &step, &err));
        run_start(&block, step, &run);
        run_advance(&block, 1, &run);
        assert_true(judge(&block, &run) < 1e-9);
        for (int32_t i = 0; i < block.interface.contact_count; i++)
            assert_int_equal(block.state.status[i], slips ? CONTACT_SLIP_FORWARD : CONTACT_STICK);
        explicit_reference_destroy(&run.scheme);
        stepped_block_destroy(&block);
    }
}

// Lifted off and pulled down, the block lands without going through the plane, and loses the rod.
TEST(test_landing)
{
    Error err = {0};
    SteppedDef def = {.cells = 4,
                      .pressure = 0.01,
                      .eta = 1,
                      .law = {.kind = FRICTION_COULOMB, .mu_static = 0.2},
                      .rod_kind = ROD_PUSHES,
                      .rod_velocity = 1e-3};
    SteppedBlock block;
    Run run;
    double step = 0, before[2 * 25];
    int32_t opened = 0;
    stepped_block_build(&def, &block);
    for (int32_t i = 0; i < block.mesh.node_count; i++) {
        block.state.displacement[2 * i] += 1e-3;   // 1 time unit ahead of the rod
        block.state.displacement[2 * i + 1] += 2e-3;
    }
    assert_true(stable_step(&block.bulk, &step, &err));
    run_start(&block, step, &run);
    for (int32_t row = 0; row < 300; row++) {
        run_advance(&block, (int64_t)(0.01 / step), &run);
        memcpy(before, block.state.displacement, sizeof before);
        run_advance(&block, 1, &run);
        for (int32_t k = 0; k < block.state.dof_count; k++)   // no jump, not even where it lands
            assert_near("u", block.state.displacement[k],
                        before[k] + step * block.state.velocity[k], 1e-15);
        assert_true(judge(&block, &run) < 1e-9);
        for (int32_t i = 0; i < block.interface.contact_count; i++) {
            int32_t node = block.interface.node[i];
            assert_true(block.state.displacement[2 * node + 1] >= -1e-16);
            opened += block.state.status[i] == CONTACT_OPEN;
        }
        bool ahead = block.state.time < 0.9, pushed = block.state.rod_touches[0];
        assert_false(ahead && pushed);
    }
    assert_true(opened > 0);
    assert_true(block.state.rod_touches[0]);
    for (int32_t i = 0; i < block.interface.contact_count; i++)
        assert_int_not_equal(block.state.status[i], CONTACT_OPEN);
    explicit_reference_destroy(&run.scheme);
    stepped_block_destroy(&block);
}

// A load that comes on top at t = 0 moves its nodes by a t^2/2 (Taylor), from the first step on.
TEST(test_sudden_load)
{
    const double step = 1e-4, more = 1e-3;
    SteppedDef def = smooth_block(0);
    def.rod_kind = ROD_AWAY;
    SteppedBlock block;
    Run run;
    stepped_block_build(&def, &block);
    int32_t dof = 2 * (block.mesh.node_count - 2) + 1;   // u_z of a node of the top
    double before = block.state.displacement[dof];
    assert_true(block.bulk.load[dof] < 0);
    block.bulk.load[dof] -= more;
    run_start(&block, step, &run);
    for (int32_t n = 1; n <= 3; n++) {
        run_advance(&block, 1, &run);
        double t = n * step, fallen = more / block.bulk.mass[dof] * t * t / 2;
        assert_near("fallen", before - block.state.displacement[dof], fallen, 1e-4 * fallen);
    }
    explicit_reference_destroy(&run.scheme);
    stepped_block_destroy(&block);
}

TEST(test_memory)
{
    SteppedDef def = smooth_block(1);
    SteppedBlock block;
    stepped_block_build(&def, &block);
    ExplicitDef parts = {.bulk = &block.bulk,
                         .interface = &block.interface,
                         .friction = &block.friction,
                         .rod = &block.rod};
    int64_t live = memory_counters().live;
    bool created = false;
    for (int32_t allowed = 0; !created; allowed++) {
        Error err = {0};
        ExplicitReference scheme;
        memory_fail_after(allowed);
        created = explicit_reference_create(&parts, &scheme, &err);
        memory_fail_after(-1);
        assert_int_equal(err.code, created ? ERROR_NONE : ERROR_MEMORY);
        explicit_reference_destroy(&scheme);
        assert_int_equal(memory_counters().live, live);
        assert_true(allowed < 20);
    }
    stepped_block_destroy(&block);
}
