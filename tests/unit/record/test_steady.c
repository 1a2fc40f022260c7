// SPDX-License-Identifier: GPL-2.0-or-later
// When a block slides steadily: on runs made up step by step. U is a tenth of the step's number.
#include "record/steady.h"

#include "seen_by_hand.h"

static const double SLIDES[SEEN_NODES] = {1, 1, 1, 1, 1}, STICKS[SEEN_NODES] = {1, 1, 0, 1, 1};
static const double FAST[SEEN_NODES] = {1, 1, 3, 1, 1};

typedef struct Slide {
    HandRun run;
    Steady steady;
    double now;   // the last mu
} Slide;

// It takes a way of 0.5: five steps after the first.
static void begin(Slide *slide)
{
    hand_run_begin(&slide->run, 1);
    slide->steady = steady_of(&slide->run.events, 0.5, 0);
    recorders_add(&slide->run.recorders, &slide->steady, steady_record);
}

// `steps` steps in which mu goes to `mu` evenly.
static void go(Slide *slide, int32_t steps, double mu, const double rate[SEEN_NODES])
{
    double from = slide->now;
    for (int32_t k = 1; k <= steps; k++)
        hand_run_see(&slide->run, from + (mu - from) * k / steps, rate);
    slide->now = mu;
}

static double mu_of(const Slide *slide)
{
    return steady_mu(&slide->steady).value;
}

TEST(test_steady)
{
    Slide slide;
    begin(&slide);
    assert_true(isnan(mu_of(&slide)));
    go(&slide, 30, 0.4, STICKS);   // mu rises, then stays: a node sticks
    go(&slide, 30, 0.4, STICKS);
    assert_true(isnan(mu_of(&slide)));
    go(&slide, 30, 0.3, SLIDES);   // all slips, mu falls
    assert_true(isnan(mu_of(&slide)));
    go(&slide, 1, 0.3, SLIDES);
    double from = slide.steady.from;
    go(&slide, 3, 0.3, SLIDES);
    assert_true(isnan(mu_of(&slide)));   // not yet the way
    go(&slide, 5, 0.3002, SLIDES);
    Estimate found = steady_mu(&slide.steady);
    // 0.3 on a way of 0.4, then five steps up.
    double way = slide.steady.to - slide.steady.from;
    assert_true(slide.steady.from <= from + 1e-12 && way > 0.85);
    assert_near("mu", found.value, 0.3 + (0.00004 * 15 * 0.1) / way, 1e-9);
    assert_near("half the range", found.error, 0.0001, 1e-12);
    go(&slide, 1, 0.3002, FAST);
    assert_true(isnan(mu_of(&slide)));   // an event is under way
    events_destroy(&slide.run.events);
}

// Slip that stops for a step begins anew; so does mu that leaves the range slowly.
TEST(test_begins_anew)
{
    Slide slide;
    begin(&slide);
    slide.now = 0.3;
    go(&slide, 20, 0.3, SLIDES);
    assert_near("mu", mu_of(&slide), 0.3, 1e-12);
    go(&slide, 1, 0.3, STICKS);
    go(&slide, 5, 0.3, SLIDES);
    assert_true(isnan(mu_of(&slide)));
    go(&slide, 40, 0.32, SLIDES);   // 0.17 % of mu a step
    assert_true(isnan(mu_of(&slide)));
    go(&slide, 400, 0.33, SLIDES);   // 0.008 %: within the range over the way
    assert_near("the mean of the last stretch", mu_of(&slide), 0.33, 0.002 * 0.33);
    events_destroy(&slide.run.events);
}

// A remembered state falls to 0.2 %, the range, over ln(500) = 6.2 times the slip over which it
// falls to 1/e: with 0.2 that is a way of 1.24, 13 steps after the first. Where mu swings it is not
// steady where it turns.
TEST(test_memory_fades)
{
    Slide slide;
    begin(&slide);
    slide.steady = steady_of(&slide.run.events, 0.5, 0.2);
    slide.now = 0.3;
    go(&slide, 13, 0.3, SLIDES);
    assert_true(isnan(mu_of(&slide)));
    go(&slide, 1, 0.3, SLIDES);
    assert_near("mu", mu_of(&slide), 0.3, 1e-12);
    go(&slide, 5, 0.31, SLIDES);
    for (int32_t k = 0; k < 4; k++) {
        go(&slide, 8, 0.31, SLIDES);
        go(&slide, 5, k % 2 ? 0.31 : 0.315, SLIDES);
    }
    go(&slide, 8, 0.315, SLIDES);
    assert_true(isnan(mu_of(&slide)));
    events_destroy(&slide.run.events);
}
