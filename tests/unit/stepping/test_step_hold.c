// SPDX-License-Identifier: GPL-2.0-or-later
// Where growth limits the step: a rung that slip outgrew is left alone for a while, so that few
// steps are done twice; and a large step, proposed just before slip runs away, is not taken.
#include "stepping/step_control.h"

#include "block_rig.h"
#include "stepping/relaxation.h"

typedef struct Run {
    BlockRig rig;
    StepControl control;
} Run;

static const double VELOCITY = 1e-5, PRESSURE = 0.003;

static RigDef pushed_def(void)
{
    RigDef def = rig_def();
    def.block.nx = 12;
    def.block.nz = 6;
    def.rod_kind = ROD_AWAY;
    def.rod_velocity = VELOCITY;
    def.rod_width = 0.25;
    return def;
}

static StepControlDef control_def(void)
{
    return (StepControlDef){.tolerance = 4e-7,
                            .step_max = 512,
                            .step_min = 1e-9,
                            .wave_step = 0.1,
                            .growth_max = 2,
                            .use_certificate = true};
}

// Relaxed under its load, the rod just touching, at t = 0.
static void run_build(const RigDef *def, const StepControlDef *steps, Run *run)
{
    Error err = {0};
    int64_t count = 0;
    rig_build(def, &run->rig);
    double velocity = run->rig.rod.velocity;
    run->rig.rod.velocity = 0;
    assert_true(step_control_create(&run->rig.block, steps, &run->control, &err));
    RelaxationDef relaxation = {.speed_max = 1e-10, .duration_max = 1e5};
    if (!relax(&run->control, &relaxation, &count, &err)) fail_msg("%s", err.message);
    for (int32_t j = 0; j < run->rig.interface.rod_count; j++)
        run->rig.rod.origin[j] =
            run->control.now
                .displacement[run->rig.interface.dofs[interface_rod(&run->rig.interface, j)]];
    run->rig.rod.velocity = velocity;
    run->rig.rod.kind = ROD_PUSHES;
    step_control_restart(&run->control);
}

static void run_destroy(Run *run)
{
    step_control_destroy(&run->control);
    rig_destroy(&run->rig);
}

static void advance(Run *run)
{
    Error err = {0};
    if (!step_control_advance(&run->control, INFINITY, &err)) fail_msg("%s", err.message);
}

static double distance(const Run *run)
{
    return run->control.now.time * VELOCITY;
}

static double friction(const Run *run)
{
    return rod_force(&run->rig.interface, run->control.now.reaction) / PRESSURE;
}

// Parameter set B, where growth limits most steps; coarse.
static RigDef strong_def(void)
{
    RigDef def = pushed_def();
    def.block.length = 0.04;
    def.block.height = 0.02;
    def.material.poisson = 0.4;
    def.law.mu_static = 1.2;
    def.law.mu_kinetic = 0.2;
    def.law.critical_velocity = 3.9e-7;
    def.rod_velocity = 2e-8;
    def.rod_height = 0.01;
    def.rod_width = 0.01;
    def.traction[1] = -5.75e-5;
    return def;
}

static StepControlDef strong_steps(void)
{
    StepControlDef steps = control_def();
    steps.tolerance = 1.15e-9;
    steps.step_max = 10;
    steps.wave_step = 0.004;
    return steps;
}

// After a refusal no step is longer than the one accepted then, for 4, 8, 16, ... steps, unless the
// state is certified in between: the waiting starts anew once it was.
static void check_hold(const RigDef *def, const StepControlDef *steps, double end, bool growing)
{
    Run run;
    run_build(def, steps, &run);
    StepControl *control = &run.control;
    int64_t wait = 0, until = 0, episodes = 0, doubled = 0;
    double limit = INFINITY;
    while (control->now.time < end) {
        int64_t before = control->counters.rejected_uncertified;
        int64_t accepted = control->counters.accepted;
        advance(&run);
        bool refused = control->counters.rejected_uncertified > before;
        if (!refused && accepted < until && control->last_step > limit)
            fail_msg("step %d: %g although %g was the limit", (int)accepted, control->last_step,
                     limit);
        for (int64_t k = before; k < control->counters.rejected_uncertified; k++) {
            wait = wait == 0 ? 4 : 2 * wait;
            if (wait > 256) wait = 256;
            doubled += wait > 4;
        }
        if (refused) {
            until = accepted + wait;
            limit = control->last_step;
            episodes++;
        }
        if (control->certified) wait = until = 0;
        assert_int_equal(control->hold, wait);
    }
    const StepCounters *counters = &control->counters;
    int64_t repeated = counters->rejected_error + counters->rejected_uncertified +
                       counters->unsolved;
    print_message("%d steps, %d repeated, %d times held, %d of them longer\n",
                  (int)counters->accepted, (int)repeated, (int)episodes, (int)doubled);
    assert_true(episodes > 5 && (doubled > 0 || !growing));
    assert_true(counters->accepted > 300 && 10 * repeated < counters->accepted);
    run_destroy(&run);
}

static void test_hold(void **state)
{
    (void)state;
    RigDef weak = pushed_def(), strong = strong_def();
    StepControlDef steps = control_def(), short_steps = strong_steps();
    check_hold(&weak, &steps, 900, false);
    check_hold(&strong, &short_steps, 200, true);
}

// The first peak of friction: where, and how high.
static void find_peak(Run *run, double *place, double *height)
{
    *height = 0;
    while (distance(run) < 6e-3 && friction(run) > *height - 0.03) {
        advance(run);
        if (friction(run) <= *height) continue;
        *height = friction(run);
        *place = distance(run);
    }
}

// Goes to `from` with care, then is told that the state is certified and the longest step is next,
// and that errors of steps do not matter.
static void tricked_peak(double from, bool use_certificate, double *place, double *height)
{
    RigDef def = pushed_def();
    StepControlDef steps = control_def();
    Run run;
    run_build(&def, &steps, &run);
    while (distance(&run) < from) advance(&run);
    StepControl *control = &run.control;
    control->def.use_certificate = use_certificate;
    control->def.tolerance = 1e-3;
    control->rung = 0;
    control->certified = true;
    control->hold = control->hold_end = 0;
    find_peak(&run, place, height);
    run_destroy(&run);
}

static void test_large_step_proposed_past_the_critical_length(void **state)
{
    (void)state;
    RigDef def = pushed_def();
    StepControlDef steps = control_def();
    steps.tolerance = 4e-8;
    steps.step_max = 1;
    Run run;
    double place, height;
    run_build(&def, &steps, &run);
    find_peak(&run, &place, &height);
    run_destroy(&run);
    const double before[] = {0.9, 0.97, 0.99, 0.995};   // of the way to the peak
    for (int32_t k = 0; k < 4; k++) {
        double seen_at, seen, missed_at, missed;
        tricked_peak(before[k] * place, true, &seen_at, &seen);
        tricked_peak(before[k] * place, false, &missed_at, &missed);
        print_message("proposed at %.3f of the way: mu %.4f at U %.5f (right: %.4f, %.5f), "
                      "without the certificate %.4f at %.5f\n",
                      before[k], seen, seen_at, height, place, missed, missed_at);
        assert_near("U", seen_at, place, 0.01 * place);
        assert_near("mu", seen, height, 0.005 * height);
        assert_true(missed > 1.008 * height && missed_at > 3 * place);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_hold),
        cmocka_unit_test(test_large_step_proposed_past_the_critical_length),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
