// SPDX-License-Identifier: GPL-2.0-or-later
// Made-up cycles of loading and sliding: which peaks there are, which count, and what they come to.
// And the recorders, by which peaks are fed after events.
#include "record/peaks.h"

#include "base/memory.h"
#include "seen_by_hand.h"

typedef struct Fixture {
    HandRun run;
    Peaks peaks;
} Fixture;

static void fixture_build(Fixture *fixture)
{
    Error err = {0};
    hand_run_begin(&fixture->run, 1);
    assert_true(peaks_create(&fixture->run.events, 0.01, &fixture->peaks, &err));
    recorders_add(&fixture->run.recorders, &fixture->peaks, peaks_record);
}

static void fixture_destroy(Fixture *fixture)
{
    peaks_destroy(&fixture->peaks);
    peaks_destroy(&fixture->peaks);
    events_destroy(&fixture->run.events);
}

static void see(Fixture *fixture, double mu, const double rate[SEEN_NODES])
{
    hand_run_see(&fixture->run, mu, rate);
}

static const double REST[] = {0, 0, 0, 0, 0}, SLOW[] = {0.5, 0.5, 0, 0, 0};
static const double FAST[] = {9, 9, 9, 0, 0}, ACROSS[] = {9, 9, 9, 9, 9};

// Loading to `mu` with the front at 0.25 (not certified from there on, if asked), then sliding.
static void cycle(Fixture *fixture, double mu, bool certified)
{
    see(fixture, 0.5 * mu, REST);
    fixture->run.hand.seen.certified = certified;
    see(fixture, mu, SLOW);
    see(fixture, 0.95 * mu, FAST);
    see(fixture, 0.9 * mu, ACROSS);
    see(fixture, 2 * mu, ACROSS);   // whatever the force does while it slides
    see(fixture, 0.3 * mu, REST);
    fixture->run.hand.seen.certified = true;
}

static void test_no_peak(void **state)
{
    (void)state;
    Fixture fixture;
    fixture_build(&fixture);
    see(&fixture, 0.2, SLOW);
    see(&fixture, 0.3, FAST);   // bounded: no sliding, no peak
    see(&fixture, 0.1, REST);
    PeaksSummary summary = peaks_summarise(&fixture.peaks);
    assert_int_equal(fixture.peaks.count, 0);
    assert_true(isnan(summary.mu_M) && isnan(summary.spread) && isnan(summary.critical_length));
    assert_true(summary.period == 0 && summary.counted == 0);
    assert_true(isnan(summary.low) && isnan(summary.high));
    assert_near("largest", fixture.peaks.mu_max, 0.3, 0);
    fixture_destroy(&fixture);
}

// A peak is the largest mu between two slidings, before the sliding and not within it.
static void test_peak_values(void **state)
{
    (void)state;
    Fixture fixture;
    fixture_build(&fixture);
    cycle(&fixture, 0.4, true);
    cycle(&fixture, 0.3, false);
    assert_int_equal(fixture.peaks.count, 2);
    const Peak *list = fixture.peaks.list;
    assert_near("mu", list[0].mu, 0.4, 0);
    assert_near("U", list[0].U, 0.1, 1e-15);   // t = 1
    assert_near("mu", list[1].mu, 0.3, 0);
    assert_near("U", list[1].U, 0.7, 1e-15);   // t = 7
    assert_near("l_c", list[1].front, 0.25, 0);   // the front just before the sliding
    assert_true(isnan(list[0].front_uncertified));
    assert_near("l_sc", list[1].front_uncertified, 0.25, 0);
    assert_near("largest", fixture.peaks.mu_max, 0.8, 0);
    fixture_destroy(&fixture);
}

// The start-up peak never counts beside others, even when it agrees.
static void test_periodic(void **state)
{
    (void)state;
    Fixture fixture;
    fixture_build(&fixture);
    const double mu[] = {0.3, 0.302, 0.301, 0.3};
    const int32_t counted[] = {1, 1, 2, 3};
    for (int32_t k = 0; k < 4; k++) {
        cycle(&fixture, mu[k], k < 2);
        PeaksSummary summary = peaks_summarise(&fixture.peaks);
        assert_int_equal(summary.counted, counted[k]);
        assert_int_equal(summary.period, k == 3 ? 1 : 0);
        assert_int_equal(isnan(summary.spread), k < 2);
    }
    PeaksSummary summary = peaks_summarise(&fixture.peaks);
    assert_near("mu_M", summary.mu_M, 0.301, 1e-15);
    assert_near("spread", summary.spread, 0.002, 1e-15);
    assert_near("l_c", summary.critical_length, 0.25, 0);
    assert_near("l_sc", summary.subcritical_length, 0.25, 0);
    assert_false(fixture.peaks.list[0].counts);
    for (int32_t k = 1; k < 4; k++) assert_true(fixture.peaks.list[k].counts);
    fixture_destroy(&fixture);
}

// What agrees with the last peak counts back to the first that does not.
static void test_settling(void **state)
{
    (void)state;
    Fixture fixture;
    fixture_build(&fixture);
    const double mu[] = {0.36, 0.3, 0.31, 0.3, 0.3005, 0.2995};
    for (int32_t k = 0; k < 6; k++) cycle(&fixture, mu[k], true);
    PeaksSummary summary = peaks_summarise(&fixture.peaks);
    assert_int_equal(summary.counted, 3);   // 0.31 is 3.5 % off
    assert_near("mu_M", summary.mu_M, 0.3, 1e-15);
    assert_true(summary.period == 1 && isnan(summary.subcritical_length));
    assert_near("low", summary.low, 0.2995, 0);
    assert_near("high", summary.high, 0.31, 0);   // the first is left out
    assert_false(fixture.peaks.list[1].counts);
    fixture_destroy(&fixture);
}

// High and low in turn: period 2 once three of each kind agree, mu_M the mean of as many high ones
// as low ones. Until then all but the start's third count.
static void test_alternating(void **state)
{
    (void)state;
    const int32_t counted[] = {1, 1, 2, 3, 4, 4, 6, 6};
    Fixture fixture;
    fixture_build(&fixture);
    for (int32_t k = 0; k < 8; k++) {
        cycle(&fixture, k % 2 ? 0.34 : 0.3, true);
        PeaksSummary summary = peaks_summarise(&fixture.peaks);
        assert_int_equal(summary.period, k >= 6 ? 2 : 0);
        assert_int_equal(summary.counted, counted[k]);
    }
    PeaksSummary summary = peaks_summarise(&fixture.peaks);
    assert_near("mu_M", summary.mu_M, 0.32, 1e-15);
    assert_near("spread", summary.spread, 0.04, 1e-15);
    assert_near("low", summary.low, 0.3, 0);
    assert_near("high", summary.high, 0.34, 0);
    assert_false(fixture.peaks.list[0].counts || fixture.peaks.list[1].counts);
    fixture_destroy(&fixture);
}

static void expect_branch(Fixture *fixture, double *above, int32_t count, double low, double high)
{
    PeakBranch branch;
    assert_true(peaks_branch_above(&fixture->peaks, *above, &branch));
    assert_int_equal(branch.count, count);
    assert_near("low", branch.low, low, 0);
    assert_near("high", branch.high, high, 0);
    assert_true(branch.mu >= low - 1e-15 && branch.mu <= high + 1e-15);   // a mean, rounded
    *above = branch.high;
}

// Periods of 3 to 8, two of whose peaks differ by less than the tolerance: every other place in the
// period is a branch of its own, and mu_M the mean of whole rounds.
static void test_long_periods(void **state)
{
    (void)state;
    for (int32_t period = 3; period <= 8; period++) {
        Fixture fixture;
        fixture_build(&fixture);
        cycle(&fixture, 0.5, true);
        for (int32_t k = 0; k < 3 * period; k++) {
            assert_int_equal(peaks_summarise(&fixture.peaks).period, 0);
            int32_t place = k % period;
            cycle(&fixture, place == 0 ? 0.3005 : 0.28 + 0.02 * place, true);
        }
        PeaksSummary summary = peaks_summarise(&fixture.peaks);
        assert_int_equal(summary.period, period);
        assert_int_equal(summary.counted, 3 * period);
        double others = 0.28 * (period - 1) + 0.02 * period * (period - 1) / 2;
        assert_near("mu_M", summary.mu_M, (0.3005 + others) / period, 1e-14);
        double above = -INFINITY;
        expect_branch(&fixture, &above, 6, 0.28 + 0.02, 0.3005);
        for (int32_t place = 2; place < period; place++)
            expect_branch(&fixture, &above, 3, 0.28 + 0.02 * place, 0.28 + 0.02 * place);
        PeakBranch none;
        assert_false(peaks_branch_above(&fixture.peaks, above, &none));
        fixture_destroy(&fixture);
    }
}

// Two branches in no order: no period, and the mean is over all but the first third.
static void test_no_period(void **state)
{
    (void)state;
    Fixture fixture;
    fixture_build(&fixture);
    const char order[] = "hhlhllhlhhhllhlllhhlhllh";
    int32_t count = (int32_t)sizeof order - 1, high = 0;
    for (int32_t k = 0; k < count; k++) {
        cycle(&fixture, order[k] == 'h' ? 0.34 : 0.3, true);
        high += k >= count / 3 && order[k] == 'h';
    }
    PeaksSummary summary = peaks_summarise(&fixture.peaks);
    int32_t counted = count - count / 3;
    if (summary.period > 0) fail_msg("period %d", summary.period);
    assert_int_equal(summary.counted, counted);
    assert_near("mu_M", summary.mu_M, (0.34 * high + 0.3 * (counted - high)) / counted, 1e-14);
    double above = -INFINITY;
    expect_branch(&fixture, &above, counted - high, 0.3, 0.3);
    expect_branch(&fixture, &above, high, 0.34, 0.34);
    fixture_destroy(&fixture);
}

// A slow drift is no agreement: what counts agrees with the very last, not only with its neighbour.
static void test_drift(void **state)
{
    (void)state;
    for (int32_t period = 1; period <= 2; period++) {
        Fixture fixture;
        fixture_build(&fixture);
        for (int32_t k = 0; k < 20; k++)
            cycle(&fixture, 0.3 * (1 + 0.004 * (k / period)) * (k % period ? 1.2 : 1), true);
        PeaksSummary summary = peaks_summarise(&fixture.peaks);
        assert_int_equal(summary.period, period);
        assert_int_equal(summary.counted, 3 * period);   // 0.8 % off, 1.2 % is too much
        fixture_destroy(&fixture);
    }
}

static void test_many(void **state)
{
    (void)state;
    Fixture fixture;
    fixture_build(&fixture);
    for (int32_t k = 0; k < 100; k++) cycle(&fixture, 0.3 + 1e-5 * k, true);
    assert_int_equal(fixture.peaks.count, 100);
    for (int32_t k = 0; k < 100; k++)
        assert_near("mu", fixture.peaks.list[k].mu, 0.3 + 1e-5 * k, 0);
    fixture_destroy(&fixture);
}

// Recorders are called in the order they were added, until one fails.
typedef struct Listener {
    int32_t *order, place;   // place: when it was called, from 1
    bool fails;
} Listener;

static bool listen(void *self, const Observation *seen, Error *err)
{
    Listener *listener = self;
    assert_near("handed on", seen->mu, 0.7, 0);
    listener->place = ++*listener->order;
    if (listener->fails) FAIL(err, ERROR_FILE, "full");
cleanup:
    return error_is_clean(err);
}

static void test_recorders(void **state)
{
    (void)state;
    Error err = {0};
    int32_t order = 0;
    Recorders recorders = {0};
    Observation seen = {.mu = 0.7};
    Listener listeners[RECORDERS_MAX] = {{0}};
    for (int32_t k = 0; k < RECORDERS_MAX; k++) {
        listeners[k].order = &order;
        recorders_add(&recorders, &listeners[k], listen);
    }
    assert_true(recorders_record(&recorders, &seen, &err));
    for (int32_t k = 0; k < RECORDERS_MAX; k++) assert_int_equal(listeners[k].place, k + 1);
    listeners[2].fails = true;
    assert_false(recorders_record(&recorders, &seen, &err));
    assert_int_equal(err.code, ERROR_FILE);
    assert_int_equal(order, RECORDERS_MAX + 3);
}

static void test_memory_faults(void **state)
{
    (void)state;
    Error err = {0};
    Fixture fixture;
    fixture_build(&fixture);
    int64_t live = memory_counters().live;
    Peaks made;
    memory_fail_after(0);
    assert_false(peaks_create(&fixture.run.events, 0.01, &made, &err));
    memory_fail_after(-1);
    assert_int_equal(err.code, ERROR_MEMORY);
    peaks_destroy(&made);
    assert_int_equal(memory_counters().live, live);
    for (int32_t k = 0; k < 16; k++) cycle(&fixture, 0.3, true);
    error_clear(&err);
    see(&fixture, 0.3, SLOW);
    hand_seen(&fixture.run.hand, fixture.run.time, ACROSS);
    assert_true(events_record(&fixture.run.events, &fixture.run.hand.seen, &err));
    memory_fail_after(0);
    assert_false(peaks_record(&fixture.peaks, &fixture.run.hand.seen, &err));
    memory_fail_after(-1);
    assert_int_equal(err.code, ERROR_MEMORY);
    assert_int_equal(fixture.peaks.count, 16);
    fixture_destroy(&fixture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_no_peak),       cmocka_unit_test(test_peak_values),
        cmocka_unit_test(test_periodic),      cmocka_unit_test(test_settling),
        cmocka_unit_test(test_alternating),   cmocka_unit_test(test_long_periods),
        cmocka_unit_test(test_no_period),     cmocka_unit_test(test_drift),
        cmocka_unit_test(test_many),          cmocka_unit_test(test_recorders),
        cmocka_unit_test(test_memory_faults),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
