// SPDX-License-Identifier: GPL-2.0-or-later
// Which steps are accepted: accuracy, contact, certificate; and what becomes of a run that
// the certificate does not hold back.
#include "stepping/step_control.h"

#include "pushed_block.h"

static void check_rules(double wave_step, double tolerance)
{
    RigDef def = pushed_def(10);
    StepControlDef steps = pushed_steps();
    steps.wave_step = wave_step;
    steps.tolerance = tolerance;
    PushedBlock run;
    pushed_build(&def, &steps, &run);
    StepControl *control = &run.control;
    assert_true(control->now.time == 0 && control->counters.accepted == 0);
    double time = 0, last = INFINITY;
    int64_t uncertified = 0, longest = 0, accepted = 0;
    while (control->now.time < 450) {
        int64_t rejections = control->counters.rejected_error +
                             control->counters.rejected_uncertified + control->counters.unsolved;
        pushed_advance(&run, INFINITY);
        bool retried = rejections != control->counters.rejected_error +
                                         control->counters.rejected_uncertified +
                                         control->counters.unsolved;
        double step = control->last_step;
        int32_t k = dt_level_find(&control->dt_levels, step);
        time += step;
        assert_near("t", control->now.time, time, 1e-9);
        assert_true(step == dt_level_step(&control->dt_levels, k));
        assert_true(control->outcome.solved && control->outcome.error <= steps.tolerance);
        assert_true(step <= 2 * last);
        if (retried) assert_true(step < last * 2);
        assert_int_equal(control->certified,
                         certificate_holds(&control->certificate, &control->now, 0));
        if (!control->certified) {
            uncertified++;
            assert_true(step <= steps.wave_step);
            assert_true(
                certificate_step_resolves(&control->certificate, &control->now,
                                          dt_level_contact(&control->dt_levels, k, PART_WHOLE), 0));
        }
        longest += step == steps.step_max;
        last = step;
    }
    for (int32_t k = 0; k < control->dt_levels.level_count; k++)
        accepted += control->dt_levels.accepted[k];
    assert_int_equal(accepted, control->counters.accepted);
    // The run saw both: long steps while certified, waves resolved while not.
    assert_true(uncertified > 10 && longest > 10);
    assert_true(control->counters.rejected_uncertified > 0);
    // A tenth of what runs allow by default (time.energy_tolerance).
    assert_true(fabs(energy_imbalance(&control->ledger)) <
                1e-4 * energy_turnover(&control->ledger));
    pushed_destroy(&run);
}

// Every accepted step keeps every rule, and the counters add up. A wave step far too long leaves it
// to the sign of det J to find what grows faster than the step.
TEST(test_rules)
{
    check_rules(0.1, 2.7e-6);
    check_rules(8, 2.7e-4);
}

// The largest F_T/F_N in the second half of the rod's way, when sliding has become periodic.
static double peak_force(bool use_certificate, double tolerance)
{
    RigDef def = pushed_def(10);
    StepControlDef steps = pushed_steps();
    steps.use_certificate = use_certificate;
    steps.tolerance = tolerance;
    PushedBlock run;
    pushed_build(&def, &steps, &run);
    double peak = 0, distance = 1e-2;
    while (pushed_way(&run) < distance) {
        pushed_advance(&run, INFINITY);
        if (pushed_way(&run) > 0.5 * distance) peak = fmax(peak, pushed_mu(&run));
    }
    pushed_destroy(&run);
    return peak;
}

// Ten times the usual tolerance leaves the answer where it is, as long as the certificate keeps
// steps short where slip can grow. Without it every step converges too, and friction comes out too
// high.
TEST(test_certificate_prevents_the_wrong_answer)
{
    double right = peak_force(true, 2.7e-6), loose = peak_force(true, 2.7e-5);
    assert_near("loose", loose, right, 2e-3 * right);
    assert_true(peak_force(false, 2.7e-5) > 1.05 * right);
}

// A finer tolerance means smaller errors and more steps.
TEST(test_tolerance)
{
    RigDef def = pushed_def(10);
    int64_t before = 0;
    for (double tolerance = 2.7e-5; tolerance > 2.7e-8; tolerance *= 0.1) {
        StepControlDef steps = pushed_steps();
        steps.tolerance = tolerance;
        PushedBlock run;
        pushed_build(&def, &steps, &run);
        while (run.control.now.time < 100) {
            pushed_advance(&run, INFINITY);
            assert_true(run.control.outcome.error <= tolerance);
        }
        assert_true(run.control.counters.accepted > before);
        before = run.control.counters.accepted;
        pushed_destroy(&run);
    }
}

// The last step does not overshoot when a built level fits.
TEST(test_remaining)
{
    RigDef def = pushed_def(10);
    StepControlDef steps = pushed_steps();
    PushedBlock run;
    pushed_build(&def, &steps, &run);
    const double end = 41.3;
    while (run.control.now.time < end) {
        double remaining = end - run.control.now.time, smallest = INFINITY;
        for (int32_t k = 0; k < run.control.dt_levels.level_count; k++)
            if (run.control.dt_levels.level[k]) smallest = dt_level_step(&run.control.dt_levels, k);
        pushed_advance(&run, remaining);
        if (smallest <= remaining) assert_true(run.control.last_step <= remaining);
    }
    assert_true(run.control.now.time < end + steps.step_max);
    pushed_destroy(&run);
}

// Contact that is never solved, or an error that is never small enough: not accepted at any step,
// the state untouched, the reason said.
TEST(test_gives_up)
{
    for (int which = 0; which < 2; which++) {
        Error err = {0};
        RigDef def = pushed_def(10);
        StepControlDef steps = pushed_steps();
        PushedBlock run;
        pushed_build(&def, &steps, &run);
        StepControl *control = &run.control;
        if (which == 0) {
            control->now.momentum[0] = NAN;
        } else {
            control->def.tolerance = 0;
        }
        double *before = hand_matrix(control->now.dof_count, 1);
        memcpy(before, control->now.displacement, (size_t)control->now.dof_count * sizeof *before);
        assert_false(step_control_advance(control, INFINITY, &err));
        assert_int_equal(err.code, ERROR_COMPUTE);
        assert_non_null(strstr(err.message, "the step went below time.step_min = 1e-09"));
        assert_non_null(strstr(err.message, which == 0 ? "contact problem" : "local error"));
        assert_int_equal(control->counters.accepted, 0);
        assert_true(control->now.time == 0);
        if (which == 0) assert_true(control->counters.unsolved > 0);
        if (which == 1) assert_true(control->counters.rejected_error > 0);
        assert_memory_equal(before, control->now.displacement,
                            (size_t)control->now.dof_count * sizeof *before);
        free(before);
        pushed_destroy(&run);
    }
}

// A tolerance of the error far too coarse: steps as long as it allows lose more energy than a run
// may. With the ledger's tolerance given the imbalance stays within that at all times.
TEST(test_energy_balance)
{
    const double allowed = 1e-3;
    RigDef def = pushed_def(10);
    double largest[2] = {0};
    for (int asked = 0; asked < 2; asked++) {
        StepControlDef steps = pushed_steps();
        steps.tolerance = 2.7e-3;
        steps.energy_tolerance = asked ? allowed : 0;
        PushedBlock run;
        pushed_build(&def, &steps, &run);
        StepControl *control = &run.control;
        while (control->now.time < 900) {
            pushed_advance(&run, INFINITY);
            double missing = fabs(energy_imbalance(&control->ledger));
            largest[asked] = fmax(largest[asked], missing / energy_turnover(&control->ledger));
        }
        print_message("%d steps, %g of the energy missing\n", (int)control->counters.accepted,
                      largest[asked]);
        assert_true((control->counters.rejected_energy > 0) == asked);
        pushed_destroy(&run);
    }
    assert_true(largest[0] > 2 * allowed && largest[1] <= allowed);
}

// A run to t = 1000, as far as it has come.
typedef struct Run {
    StepControl control;
    Error err;
} Run;

// `count` steps of dt each; false: refused.
static bool go_on(Run *run, int64_t count, double dt)
{
    for (int64_t k = 0; k < count; k++) {
        run->control.now.time += dt;
        run->control.counters.accepted++;
        if (!step_control_gets_on(&run->control, 1000, &run->err)) return false;
    }
    return true;
}

// Many short steps between long ones, as in an event, are no standstill.
TEST(test_short_steps_that_end)
{
    Run run = {0};
    assert_true(go_on(&run, STEPS_LOOKED / 2, 1e-2));
    assert_true(go_on(&run, STEPS_LOOKED - 10, 1e-9));
    assert_true(go_on(&run, STEPS_LOOKED, 1e-2));
}

// Nor are events that take longer than a look, at steps that resolve waves, and come again.
TEST(test_long_events)
{
    Run run = {.control.def.wave_step = 1e-9};
    for (int32_t k = 0; k < 5; k++) {
        assert_true(go_on(&run, STEPS_LOOKED / 4, 1e-2));
        assert_true(go_on(&run, 2 * STEPS_LOOKED, 1e-9));
    }
    Run endless = {.control.def.wave_step = 1e-6};   // from the start on, and 1e9 of them to go
    assert_false(go_on(&endless, STEPS_LOOKED, 1e-6));
}

// 1000 away at 1e-6: 1e9 steps.
TEST(test_standstill)
{
    Run run = {0};
    assert_true(go_on(&run, STEPS_LOOKED / 2, 1e-2));
    assert_false(go_on(&run, 3 * STEPS_LOOKED, 1e-6));
    assert_in_range(run.control.counters.accepted, STEPS_LOOKED, 2 * STEPS_LOOKED);
    assert_int_equal(run.err.code, ERROR_COMPUTE);
    assert_non_null(strstr(run.err.message, "steps of 1e-06"));
    assert_non_null(strstr(run.err.message, "9.0e+08"));
}

// 1e7 steps to go are many, and no reason to refuse.
TEST(test_long_runs)
{
    Run run = {0};
    assert_true(go_on(&run, 2 * STEPS_LOOKED, 1e-4));
}

// In the loop nothing is allocated but new levels.
TEST(test_allocations)
{
    Error err = {0};
    RigDef def = pushed_def(10);
    StepControlDef steps = pushed_steps();
    PushedBlock run;
    pushed_build(&def, &steps, &run);
    for (int32_t k = 0; k < 14; k++)
        assert_non_null(dt_level_operator(&run.control.dt_levels, k, PART_WHOLE, &err));
    int64_t allocations = memory_counters().allocations;
    while (run.control.now.time < 450) pushed_advance(&run, INFINITY);
    assert_int_equal(memory_counters().allocations, allocations);
    pushed_destroy(&run);
}

// Before the first step, when no level is built, any way left is one to go; where no level resolves
// waves the shortest is the first.
TEST(test_before_the_first_step)
{
    Error err = {0};
    BlockRig rig;
    StepControl control;
    RigDef def = pushed_def(4);
    StepControlDef steps = pushed_steps();
    steps.step_min = 2 * steps.wave_step;
    rig_build(&def, &rig);
    assert_true(step_control_create(&rig.block, &steps, &control, &err));
    assert_true(step_control_fits(&control, 1e-30));
    assert_false(step_control_fits(&control, 0));
    assert_int_equal(control.level, control.dt_levels.level_count - 1);
    step_control_destroy(&control);
    rig_destroy(&rig);
}

TEST(test_memory_faults)
{
    RigDef def = rig_def();
    StepControlDef steps = pushed_steps();
    BlockRig rig;
    rig_build(&def, &rig);
    int64_t live = memory_counters().live;
    bool done = false;
    for (int32_t k = 0; !done; k++) {
        Error err = {0};
        StepControl control;
        memory_fail_after(k);
        done = step_control_create(&rig.block, &steps, &control, &err) &&
               step_control_advance(&control, INFINITY, &err);
        memory_fail_after(-1);
        assert_int_equal(err.code, done ? ERROR_NONE : ERROR_MEMORY);
        step_control_destroy(&control);
        assert_int_equal(memory_counters().live, live);
    }
    rig_destroy(&rig);
}
