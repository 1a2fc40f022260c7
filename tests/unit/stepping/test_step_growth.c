// SPDX-License-Identifier: GPL-2.0-or-later
// Where growth limits the step: few steps are done twice, and a large step that is proposed just
// before slip runs away is not taken.
#include "stepping/step_control.h"

#include "pushed_block.h"

static StepControlDef long_steps(void)
{
    StepControlDef steps = pushed_steps();
    steps.step_max = 512;
    return steps;
}

// Parameter set B, where growth limits most steps; coarse.
static RigDef strong_def(void)
{
    RigDef def = pushed_def(12);
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
    StepControlDef steps = long_steps();
    steps.tolerance = 8e-9;
    steps.step_max = 10;
    steps.wave_step = 0.004;
    return steps;
}

// Steps refused because slip grew, and taken again, are few, and what follows a refusal at once is
// no longer than what was accepted then.
static void check_refused(const RigDef *def, const StepControlDef *steps, double end)
{
    PushedBlock run;
    pushed_build(def, steps, &run);
    StepControl *control = &run.control;
    const StepCounters *counters = &control->counters;
    bool refused = false;
    double last = 0;
    int64_t met = 0;
    while (control->now.time < end) {
        int64_t before = counters->rejected_uncertified;
        pushed_advance(&run, INFINITY);
        assert_false(refused && control->last_step > last);
        refused = counters->rejected_uncertified > before;
        last = control->last_step;
        met += refused;
    }
    print_message("%d steps, %d refused as slip grew\n", (int)counters->accepted,
                  (int)counters->rejected_uncertified);
    assert_true(met > 5 && counters->accepted > 300);
    assert_true(10 * counters->rejected_uncertified < counters->accepted);
    pushed_destroy(&run);
}

TEST(test_refused)
{
    RigDef weak = pushed_def(12), strong = strong_def();
    StepControlDef steps = long_steps(), short_steps = strong_steps();
    check_refused(&weak, &steps, 900);
    check_refused(&strong, &short_steps, 200);
}

// The first peak of friction: where, and how high.
static void find_peak(PushedBlock *run, double *place, double *height)
{
    *height = 0;
    while (pushed_way(run) < 6e-3 && pushed_mu(run) > *height - 0.03) {
        pushed_advance(run, INFINITY);
        if (pushed_mu(run) <= *height) continue;
        *height = pushed_mu(run);
        *place = pushed_way(run);
    }
}

// Goes to `from` with care, then is told that the state is certified and the longest step is next,
// and that errors of steps do not matter.
static void tricked_peak(double from, bool use_certificate, double *place, double *height)
{
    RigDef def = pushed_def(12);
    StepControlDef steps = long_steps();
    PushedBlock run;
    pushed_build(&def, &steps, &run);
    while (pushed_way(&run) < from) pushed_advance(&run, INFINITY);
    StepControl *control = &run.control;
    control->def.use_certificate = use_certificate;
    control->def.tolerance = 7e-3;
    control->level = 0;
    control->certified = true;
    find_peak(&run, place, height);
    pushed_destroy(&run);
}

TEST(test_large_step_proposed_past_the_critical_length)
{
    RigDef def = pushed_def(12);
    StepControlDef steps = long_steps();
    steps.tolerance = 2.7e-7;
    steps.step_max = 1;
    PushedBlock run;
    double place, height;
    pushed_build(&def, &steps, &run);
    find_peak(&run, &place, &height);
    pushed_destroy(&run);
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

// The record covers whatever comes.
static void make_gullible(PushedBlock *run)
{
    OscillationRecord *record = &run->control.oscillations;
    record->seen_for = INFINITY;
    for (int32_t k = 0; k < record->interface->contact_count; k++) record->weakening[k] = INFINITY;
}

// To the end of the first sliding; returns mu's largest on the way.
static double first_sliding(PushedBlock *run, bool gullible)
{
    double height = 0;
    while (pushed_way(run) < 5e-3 && pushed_mu(run) >= 0.6 * height) {
        if (gullible) make_gullible(run);
        pushed_advance(run, INFINITY);
        height = fmax(height, pushed_mu(run));
    }
    return height;
}

// Steps of a rod at `velocity` until the block has slid once; watch: 0 resolves every oscillation.
static int64_t slow_rod(double velocity, double watch, double *height, int64_t *stepped_over)
{
    RigDef def = pushed_def(12);
    def.rod_velocity = velocity;
    StepControlDef steps = pushed_steps();
    steps.step_max = 0.1 * exp2(ceil(log2(84 * 1e-5 / velocity)));
    steps.watch_time = watch;
    PushedBlock run;
    pushed_build(&def, &steps, &run);
    *height = first_sliding(&run, false);
    *stepped_over = run.control.counters.stepped_over_oscillations;
    int64_t accepted = run.control.counters.accepted;
    pushed_destroy(&run);
    return accepted;
}

// Where slip oscillates, a slower rod meets more oscillations. Those that stay small are stepped
// over: the cost stays, the friction is that of the run that follows each of them, and so is a run
// in which the rod outruns its oscillations.
TEST(test_slow_rod)
{
    double height, followed;
    int64_t stepped_over, first = 0, before = 0;
    for (double velocity = 1e-5; velocity > 0.9e-8; velocity *= 0.1) {
        int64_t accepted = slow_rod(velocity, 20, &height, &stepped_over);
        print_message("V %g: %d steps, %d of them over oscillations, mu %.4f\n", velocity,
                      (int)accepted, (int)stepped_over, height);
        if (velocity == 1e-5) {
            assert_int_equal(accepted, slow_rod(velocity, 0, &followed, &stepped_over));
            assert_true(height == followed && stepped_over == 0);
            first = accepted;
        } else {
            assert_true(stepped_over > 0);
        }
        if (velocity < 2e-7 && velocity > 0.9e-7) {
            int64_t all = slow_rod(velocity, 0, &followed, &stepped_over);
            print_message("    each oscillation resolved: %d steps, mu %.4f\n", (int)all, followed);
            assert_true(all > 5 * accepted);
            assert_near("mu", height, followed, 0.01 * followed);
        }
        before = accepted;
    }
    assert_true(before < 3 * first);
}

// Oscillations stepped over or not, what runs away does: the growth tests alone see to that, should
// the record cover whatever comes. Without any certificate mu goes on rising.
TEST(test_runaway_of_a_slow_rod)
{
    enum { AS_EVER, GULLIBLE, UNCERTIFIED, WAYS };
    double place[WAYS], height[WAYS];
    for (int way = 0; way < WAYS; way++) {
        RigDef def = pushed_def(12);
        def.rod_velocity = 1e-8;
        StepControlDef steps = pushed_steps();
        steps.step_max = 0.1 * exp2(20);
        steps.watch_time = 20;
        steps.use_certificate = way != UNCERTIFIED;
        PushedBlock run;
        pushed_build(&def, &steps, &run);
        height[way] = first_sliding(&run, way == GULLIBLE);
        place[way] = pushed_way(&run);
        print_message("mu falls from %.4f at U %.5f\n", height[way], place[way]);
        pushed_destroy(&run);
    }
    assert_near("U", place[GULLIBLE], place[AS_EVER], 0.02 * place[AS_EVER]);
    assert_near("mu", height[GULLIBLE], height[AS_EVER], 0.005 * height[AS_EVER]);
    assert_true(place[UNCERTIFIED] > 1.5 * place[AS_EVER]);
}
