// SPDX-License-Identifier: GPL-2.0-or-later
// Answers from made-up drops, and from a real block whose peaks alternate between two
// values.
#include "answers/answers.h"

#include "amontons.h"
#include "drops_by_hand.h"
#include "plane.h"
#include "seen_by_hand.h"

#include <math.h>

TEST(test_nothing)
{
    HandDrops hand;
    hand_drops_begin(&hand, 2);
    see(&hand, 0.2, SLOW);
    drop(&hand, 0.3, 0.299, PART);   // a precursor
    Answers found = answers_of(&hand.drops);
    assert_true(isnan(found.mu_M.value) && isnan(found.mu_M_spread) && isnan(found.mu_hold.value));
    assert_true(isnan(found.critical_length) && isnan(found.mu_M_low));
    assert_true(found.period == 0 && found.peaks == 0 && !found.enough);
    assert_near("largest", found.mu_max, 0.3, 0);
    assert_near("two steps", found.mu_max_jump, 0, 0);
    see(&hand, 0.8, REST);   // one step, as where the rod hits the block
    see(&hand, 0.25, REST);
    assert_near("above its neighbours", answers_of(&hand.drops).mu_max_jump, 0.501, 1e-15);
    hand_drops_end(&hand);
}

// The start's drop never counts beside others, even when it agrees. Three that do make a period.
TEST(test_settling)
{
    const double mu[] = {0.3, 0.3, 0.302, 0.301};
    const int32_t counted[] = {1, 1, 2, 3};
    HandDrops hand;
    hand_drops_begin(&hand, 1);
    for (int32_t k = 0; k < 4; k++) {
        hand.run.hand.seen.certified = k < 2;
        drop(&hand, mu[k], 0.1, ACROSS);
        hand.run.hand.seen.certified = true;
        Answers found = answers_of(&hand.drops);
        assert_int_equal(found.peaks, k + 1);
        assert_int_equal(found.peaks_counted, counted[k]);
        assert_int_equal(found.period, k == 3 ? 1 : 0);
        assert_int_equal(found.enough, k == 3);
        assert_int_equal(isnan(found.mu_M_spread), k < 2);
    }
    Answers found = answers_of(&hand.drops);
    assert_int_equal(found.first, 1);
    assert_near("mu_M", found.mu_M.value, 0.301, 1e-15);
    assert_near("its error", found.mu_M.error, 4.30 * 0.001 / sqrt(3), 1e-15);
    assert_near("spread", found.mu_M_spread, 0.002, 1e-15);
    assert_near("holds", found.mu_hold.value, 0.3, 0);
    assert_near("its error", found.mu_hold.error, 0.001, 1e-15);
    assert_near("l_c", found.critical_length, 0.25, 0);
    assert_near("l_sc", found.subcritical_length, 0, 0);
    hand_drops_end(&hand);
}

// By turns 7 pads, say, and the whole block: one period rules both answers. mu_M is the mean of the
// bulk slidings alone, which then repeat after one; the contact holds what the lower drops say.
TEST(test_pads_by_turns)
{
    HandDrops hand;
    hand_drops_begin(&hand, 2);
    drop(&hand, 0.5, 0.1, ACROSS);
    for (int32_t k = 0; k < 5; k++) {
        assert_false(answers_of(&hand.drops).enough);
        drop(&hand, k % 2 ? 0.3 + 0.001 * k : 0.25, 0.1, k % 2 ? ACROSS : LEFT);
    }
    assert_true(answers_of(&hand.drops).enough);
    Answers found = answers_of(&hand.drops);
    assert_true(found.regime.period == 2 && found.regime.count == 4);
    assert_true(found.period == 1 && found.peaks == 3 && found.peaks_counted == 2);
    assert_near("mu_M", found.mu_M.value, 0.302, 1e-15);
    assert_near("holds", found.mu_hold.value, 0.25, 0);
    assert_near("mean", found.mu_drops.value, (0.25 + 0.302) / 2, 1e-15);
    hand_drops_end(&hand);
}

// A period in which the block never slides as a whole, the pads by turns: the start's peak is not
// mu_M.
TEST(test_parts_only)
{
    static const double right[] = {0, 0, 0, 9, 9};
    HandDrops hand;
    hand_drops_begin(&hand, 2);
    drop(&hand, 0.5, 0.1, ACROSS);
    for (int32_t k = 0; k < 5; k++) drop(&hand, k % 2 ? 0.31 : 0.3, 0.1, k % 2 ? right : LEFT);
    Answers found = answers_of(&hand.drops);
    assert_true(found.enough && found.peaks == 1 && found.peaks_counted == 0);
    assert_true(found.regime.period == 2 && found.regime.run_in == RUN_IN_OVER);
    assert_true(found.period == 0 && isnan(found.mu_M.value) && isnan(found.mu_M.error));
    assert_near("holds", found.mu_hold.value, 0.3, 0);
    hand_drops_end(&hand);
}

// One pad alone slides: the other is loaded more and more, however alike mu is at these drops.
// Before the other has slipped at all there is no answer; when it lags behind only one for now.
TEST(test_stuck_pad)
{
    HandDrops hand;
    hand_drops_begin(&hand, 2);
    hand.drops.mu_static = 0.33;
    for (int32_t k = 0; k < 6; k++) drop(&hand, 0.3 + 0.001 * k, 0.1, LEFT);
    Answers found = answers_of(&hand.drops);
    assert_true(!found.enough && found.regime.run_in == RUN_IN_STUCK && found.regime.period == 0);
    assert_true(isnan(found.mu_hold.value) && isnan(found.mu_M.value));
    assert_near("rises", found.regime.drift, 0.001 / 0.305, 1e-12);
    assert_near("until mu_S", found.regime.drops_left, 25, 0);
    drop(&hand, 0.31, 0.1, ACROSS);
    assert_near("one peak", answers_of(&hand.drops).mu_M.value, 0.31, 0);
    for (int32_t k = 0; k < 6; k++) {
        drop(&hand, 0.3, 0.1, LEFT);
        assert_false(answers_of(&hand.drops).enough);
    }
    found = answers_of(&hand.drops);
    assert_true(found.regime.run_in == RUN_IN_LAGS && found.regime.period == 0);
    assert_near("so far", found.mu_hold.value, 0.3, 0);
    hand_drops_end(&hand);
}

// mu of a drop as a stranger's problem had it: each within 1 % of the last, and a trend all the
// same. When it has faded there is a period.
TEST(test_trend)
{
    static const double rising[] = {0.5, 0.5434, 0.5446, 0.5459, 0.5473};
    HandDrops hand;
    hand_drops_begin(&hand, 1);
    for (int32_t k = 0; k < 5; k++) drop(&hand, rising[k], 0.1, ACROSS);
    Answers found = answers_of(&hand.drops);
    assert_true(found.regime.run_in == RUN_IN_TREND && !found.enough && found.period == 0);
    assert_near("a drop", found.regime.drift, 0.0013 / 0.5473, 1e-4);
    for (int32_t k = 1; k < 5; k++) drop(&hand, 0.5473 + 0.0004 * (1 - pow(0.2, k)), 0.1, ACROSS);
    found = answers_of(&hand.drops);
    assert_true(found.regime.run_in == RUN_IN_OVER && found.enough && found.period == 1);
    assert_true(found.peaks_counted <= 5 && found.mu_M.value > 0.547);   // not those that rose
    hand_drops_end(&hand);
}

// By turns at a higher and a lower mu, each time further apart (a block with a hole on a soft
// machine, whose drops settled elsewhere after twenty of them): rounds agree within 1 %, their mean
// has no trend, and the run-in is not over.
TEST(test_alternation_that_grows)
{
    static const double apart[] = {0.004, 0.0046, 0.0053, 0.0059, 0.0063, 0.007, 0.0074, 0.0081};
    HandDrops hand;
    hand_drops_begin(&hand, 1);
    drop(&hand, 0.43, 0.1, ACROSS);
    for (int32_t k = 0; k < 8; k++)
        drop(&hand, 0.412 + (k % 2 ? apart[k] : -apart[k]), 0.1, ACROSS);
    Answers found = answers_of(&hand.drops);
    assert_true(found.regime.run_in == RUN_IN_TREND && !found.enough && found.period == 0);
    hand_drops_end(&hand);
}

// mu alone comes back, the load is shared out otherwise each time: no period.
TEST(test_shares_move)
{
    for (int32_t moves = 0; moves < 2; moves++) {
        HandDrops hand;
        hand_drops_begin(&hand, 2);
        for (int32_t k = 0; k < 6; k++) {
            for (int32_t i = 0; i < SEEN_NODES; i++) {
                double share = i < 3 ? 0.15 + 0.01 * k * moves : 0.15 - 0.015 * k * moves;
                hand.run.hand.reaction[plane_tangent(i)] = -0.2 * share;
                hand.run.hand.reaction[plane_normal(i)] = 0.2;
            }
            drop(&hand, 0.15, 0.05, ACROSS);
        }
        assert_int_equal(answers_of(&hand.drops).period, moves ? 0 : 1);
        hand_drops_end(&hand);
    }
}

// No period: all but the first quarter count, and 30 of them are enough once their mean is known to
// 2 %. mu_M is the mean of the largest mu before each bulk sliding among them, also where only
// parts slid when it was reached.
TEST(test_without_period)
{
    HandDrops hand;
    hand_drops_begin(&hand, 2);
    for (int32_t k = 0; k < 10; k++) drop(&hand, 0.1, 0.05, ACROSS);
    double sum = 0, largest = 0;
    for (int32_t k = 0; k < 30; k++) {
        double mu = 0.3 + 0.01 * ((7 * k * k) % 20);
        drop(&hand, mu, 0.1, k % 3 ? LEFT : ACROSS);
        largest = fmax(largest, mu);
        if (k % 3) continue;
        sum += largest;
        largest = 0;
    }
    Answers found = answers_of(&hand.drops);
    assert_true(found.regime.period == 0 && found.regime.count == 30 && found.peaks_counted == 10);
    assert_near("mu_M", found.mu_M.value, sum / 10, 1e-12);
    // By numpy: mean, std(ddof=1), quantile(0.1) of these 30. Errors: 2.046 standard errors, by
    // Student for 30, with a correlation of neighbours of 0.198; blocks of six say less.
    assert_near("of all", found.mu_drops.value, 0.375, 1e-9);
    assert_near("its error", found.mu_drops.error, 2 * 0.0102449823287769, 1e-9);
    assert_near("holds", found.mu_hold.value, 0.327, 1e-9);
    assert_near("its error", found.mu_hold.error, 2 * 0.015, 1e-9);
    assert_false(found.enough);   // 30 of them, but the mean is known to 2.2 % only
    for (int32_t k = 30; k < 80; k++)
        drop(&hand, 0.3 + 0.01 * ((7 * k * k) % 20), 0.1, k % 3 ? LEFT : ACROSS);
    assert_true(answers_of(&hand.drops).enough);
    hand_drops_end(&hand);
}

// L = 4, set A, P = 0.00222 on few cells: slidings by turns at 0.24 and 0.27. A run that stops
// because its drops repeat says after how many, and mu_M is the mean of whole rounds. (Down to
// 0.0022, and above 0.00223, rounding decides: of 24 pressures within 0.24 % the whole mesh has
// period 2 at 19, others at the rest. Between them whole mesh and halves all have it.)
TEST(test_block_of_period_two)
{
    static const char *const overrides[] = {
        "mesh.set={length: 4, height: 2, nx: 32, nz: 16}",
        "rod.height=1",
        "rod.width=0.2",
        "load.pressure=0.00222",
        "time.periodic_tolerance=0.02",
        "time.until={U: 0.8, periodic: true}",
        "output={history: false, fields: none, figures: []}",
    };
    Error err = {0};
    char path[600];
    Scene *scene = NULL;
    RunOptions options = {.folder = NULL};
    RunSummary summary;
    snprintf(path, sizeof path, "%s/validation/paper/fig1.yaml", getenv("AMONTONS_SOURCE"));
    if (!amontons_scene_read(path, overrides, 7, &scene, &err) ||
        !amontons_run(scene, &options, &summary, &err))
        fail_msg("%s", err.message);
    assert_int_equal(summary.period, 2);
    assert_int_equal(summary.drop_period, 2);
    assert_true(summary.peaks_counted >= 4 && summary.peaks_counted % 2 == 0);
    assert_true(summary.mu_M > summary.mu_hold &&
                summary.mu_M < summary.mu_hold + summary.mu_M_spread);
    // Rounds agree, branches differ: as scatter of single peaks the bar would be half the spread or
    // more. (How well two rounds agree, within 2 %, is a matter of rounding: 0.02 to 0.11.)
    assert_true(summary.mu_M_error < 0.2 * summary.mu_M_spread);
    amontons_scene_destroy(scene);
}

// --- the first loading, apart from what comes after it ------------------------------------------

static const double HALF[] = {9, 9, 9, 0, 0};

TEST(test_before_it_slides)
{
    HandDrops hand;
    hand_drops_begin(&hand, 1);
    FirstLoading none = first_loading_of(&hand.drops);
    assert_true(!none.slid && none.precursors == 0 && isnan(none.mu.value));
    drop(&hand, 0.3, 0.299, PART);
    drop(&hand, 0.35, 0.349, HALF);
    FirstLoading first = first_loading_of(&hand.drops);
    assert_true(!first.slid && isnan(first.mu.value) && isnan(first.critical_length));
    assert_int_equal(first.precursors, 2);
    hand_drops_end(&hand);
}

// One precursor comes to the trailing node alone and one to the middle, then the block slides; the
// later cycles have one precursor each. U of step t is t/10.
TEST(test_beside_the_regime)
{
    HandDrops hand;
    hand_drops_begin(&hand, 1);
    hand.run.hand.seen.trailing = -0.1;
    drop(&hand, 0.3, 0.299, PART);
    drop(&hand, 0.35, 0.349, HALF);
    drop(&hand, 0.4, 0.2, ACROSS);
    for (int32_t k = 0; k < 3; k++) {
        drop(&hand, 0.28, 0.279, HALF);
        drop(&hand, 0.33, 0.2, ACROSS);
    }
    FirstLoading first = first_loading_of(&hand.drops);
    assert_true(first.slid);
    assert_near("mu", first.mu.value, 0.4, 0);
    assert_near("U", first.U, 1.1, 1e-15);
    assert_true(isnan(first.mu.error));   // one value has no scatter of its own
    assert_int_equal(first.precursors, 2);
    assert_near("l_c", first.critical_length, 0.25 + 0.1, 1e-15);
    assert_near("longest", first.longest, 0.5 + 0.1, 1e-15);
    LaterCycles later = later_cycles_of(&hand.drops, 1);
    assert_int_equal(later.count, 3);
    assert_near("from peak to peak", later.way, 1, 1e-15);
    assert_near("precursors", later.precursors, 1, 0);
    assert_near("longest", later.longest, 0.6, 1e-15);
    hand_drops_end(&hand);
}

// Slip turned fast behind the front; then over three quarters of the contact, of which a third was
// behind it: the front says nothing of when the block slid.
TEST(test_slip_that_turns_fast_elsewhere)
{
    const double elsewhere[] = {0.5, 0.5, 0, 0.5, 0.5};
    for (int32_t k = 0; k < 2; k++) {
        HandDrops hand;
        hand_drops_begin(&hand, 1);
        see(&hand, 0.2, REST);
        see(&hand, 0.4, k == 0 ? SLOW : elsewhere);
        see(&hand, 0.4, ACROSS);
        see(&hand, 0.1, REST);
        FirstLoading first = first_loading_of(&hand.drops);
        assert_true(first.slid && isnan(first.critical_length) == (k == 1));
        hand_drops_end(&hand);
    }
}

// The load gained since the last precursor: one of them more or less changes the peak by a part of
// it.
TEST(test_since_the_last_precursor)
{
    HandDrops hand;
    hand_drops_begin(&hand, 1);
    drop(&hand, 0.3, 0.299, HALF);
    drop(&hand, 0.35, 0.349, HALF);
    drop(&hand, 0.4, 0.2, ACROSS);
    assert_near("since", first_loading_of(&hand.drops).since_precursor, 0.05, 1e-15);
    hand_drops_end(&hand);
    hand_drops_begin(&hand, 1);
    drop(&hand, 0.4, 0.2, ACROSS);
    assert_near("none", first_loading_of(&hand.drops).since_precursor, 0, 0);
    hand_drops_end(&hand);
}

// A block that slid from t = 0 on has no first loading: nothing had held before.
TEST(test_sliding_from_the_start)
{
    HandDrops hand;
    hand_drops_begin(&hand, 1);
    for (int32_t k = 0; k < 3; k++) see(&hand, 0.2, ACROSS);
    see(&hand, 0.2, REST);
    drop(&hand, 0.4, 0.2, ACROSS);
    FirstLoading first = first_loading_of(&hand.drops);
    assert_true(!first.slid && isnan(first.mu.value));
    assert_int_equal(first.precursors, 0);
    hand_drops_end(&hand);
}

// --- kinds of mu_M, on steps by hand: U is a tenth of the number --------------------------------

static const double SLIDES[SEEN_NODES] = {1, 1, 1, 1, 1}, STICKS[SEEN_NODES] = {1, 1, 0, 1, 1};

typedef struct Slide {
    HandRun run;
    Steady steady;
    double now;   // the last mu
} Slide;

// It takes a way of 0.5: five steps after the first.
static void begin_slide(Slide *slide)
{
    hand_run_begin(&slide->run, 1);
    slide->steady = steady_of(&slide->run.events, 0.5, 0);
    recorders_add(&slide->run.recorders, &slide->steady, steady_record);
}

// `steps` steps in which mu goes to `mu` evenly.
static void go_on(Slide *slide, int32_t steps, double mu, const double rate[SEEN_NODES])
{
    double from = slide->now;
    for (int32_t k = 1; k <= steps; k++)
        hand_run_see(&slide->run, from + (mu - from) * k / steps, rate);
    slide->now = mu;
}

// The kind of mu_M, and why there is none.
TEST(test_steady_answer)
{
    Slide slide;
    Answers none = {.mu_M = {NAN, NAN}},
            peaks = {.mu_M = {0.35, 0.01}, .peaks_counted = 3, .peaks = 4};
    begin_slide(&slide);
    slide.now = 0.3;
    go_on(&slide, 3, 0.3, SLIDES);
    assert_non_null(strstr(steady_words(&slide.steady, &none), "not steady yet"));
    go_on(&slide, 20, 0.3, SLIDES);
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
    go_on(&slide, 1, 0.3, STICKS);
    assert_non_null(
        strstr(steady_words(&slide.steady, &none), "none: the block as a whole did not"));
    slide.run.events.kinds[EVENT_LEADING] = 1;
    assert_non_null(strstr(steady_words(&slide.steady, &none), "slid from the start on"));
    none.peaks = 1;
    assert_non_null(strstr(steady_words(&slide.steady, &none), "belong to the start or run-in"));
    events_destroy(&slide.run.events);
}
