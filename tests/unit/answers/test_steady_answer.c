// SPDX-License-Identifier: GPL-2.0-or-later
// Kinds of mu_M, on runs made up step by step. U is a tenth of the step's number.
#include "answers/steady_answer.h"

#include "seen_by_hand.h"

static const double SLIDES[SEEN_NODES] = {1, 1, 1, 1, 1}, STICKS[SEEN_NODES] = {1, 1, 0, 1, 1};

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

// The kind of mu_M, and why there is none.
TEST(test_answer)
{
    Slide slide;
    Answers none = {.mu_M = {NAN, NAN}},
            peaks = {.mu_M = {0.35, 0.01}, .peaks_counted = 3, .peaks = 4};
    begin(&slide);
    slide.now = 0.3;
    go(&slide, 3, 0.3, SLIDES);
    assert_non_null(strstr(steady_words(&slide.steady, &none), "not steady yet"));
    go(&slide, 20, 0.3, SLIDES);
    Answers found = none;
    steady_answer(&slide.steady, &found);
    assert_near("mu_M", found.mu_M.value, 0.3, 1e-12);
    assert_near("error", found.mu_M.error, 0, 0);   // it never moved
    assert_true(found.steady);
    assert_string_equal(steady_words(&slide.steady, &found), "steady sliding");
    found = peaks;
    steady_answer(&slide.steady, &found);
    assert_near("peaks count more", found.mu_M.value, 0.35, 0);
    assert_string_equal(steady_words(&slide.steady, &found), "peaks");
    go(&slide, 1, 0.3, STICKS);
    assert_non_null(
        strstr(steady_words(&slide.steady, &none), "none: the block as a whole did not"));
    slide.run.events.kinds[EVENT_LEADING] = 1;
    assert_non_null(strstr(steady_words(&slide.steady, &none), "slid from the start on"));
    none.peaks = 1;
    assert_non_null(strstr(steady_words(&slide.steady, &none), "belong to the start or run-in"));
    events_destroy(&slide.run.events);
}
