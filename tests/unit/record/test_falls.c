// SPDX-License-Identifier: GPL-2.0-or-later
// Made-up force curves on two pads (nodes 0 to 2, and 3 and 4): which drops count as falls, after
// how many they repeat, which branch is the lowest.
#include "record/falls.h"

#include "base/memory.h"
#include "seen_by_hand.h"

typedef struct Fixture {
    HandRun run;
    Pads pads;
    Falls falls;
} Fixture;

static void fixture_build(Fixture *fixture)
{
    Error err = {0};
    hand_run_begin(&fixture->run, 2);
    assert_true(
        pads_create(&fixture->run.hand.interface, &fixture->run.events, &fixture->pads, &err));
    assert_true(falls_create(&fixture->run.events, &fixture->pads, 1e-2, &fixture->falls, &err));
    recorders_add(&fixture->run.recorders, &fixture->pads, pads_record);
    recorders_add(&fixture->run.recorders, &fixture->falls, falls_record);
}

static void fixture_destroy(Fixture *fixture)
{
    falls_destroy(&fixture->falls);
    falls_destroy(&fixture->falls);
    pads_destroy(&fixture->pads);
    events_destroy(&fixture->run.events);
}

static const double REST[] = {0, 0, 0, 0, 0}, ACROSS[] = {9, 9, 9, 9, 9}, LEFT[] = {9, 9, 9, 0, 0};

static void see(Fixture *fixture, double mu, const double rate[SEEN_NODES])
{
    hand_run_see(&fixture->run, mu, rate);
}

// Slow rise to `peak`, an event with these rates down to `after`, rest.
static void fall(Fixture *fixture, double peak, double after, const double rate[SEEN_NODES])
{
    see(fixture, 0.5 * peak, REST);
    see(fixture, peak, REST);
    see(fixture, peak, rate);
    see(fixture, after, rate);
    see(fixture, after, REST);
}

// Drops of 4 % are none, whoever slides; of 6 % are one, also where only some of one pad slips. A
// fall carries the largest mu since the fall before.
static void test_which_count(void **state)
{
    (void)state;
    Fixture fixture;
    fixture_build(&fixture);
    const Falls *falls = &fixture.falls;
    fall(&fixture, 0.3, 0.288, ACROSS);
    assert_int_equal(falls->count, 0);
    fall(&fixture, 0.2, 0.188, (double[]){9, 0, 0, 0, 0});
    assert_int_equal(falls->count, 1);
    assert_near("mu", falls->list[0].mu, 0.3, 0);
    assert_near("U", falls->list[0].U, 0.1, 1e-15);   // of the first event's peak
    assert_near("after", falls->list[0].mu_after, 0.188, 0);
    assert_int_equal(falls->list[0].pads, 0);
    fall(&fixture, 0.25, 0.1, LEFT);
    fall(&fixture, 0.4, 0.05, ACROSS);
    assert_int_equal(falls->count, 3);
    assert_near("mu", falls->list[1].mu, 0.25, 0);
    assert_near("U", falls->list[1].U, 1.1, 1e-12);
    assert_true(falls->list[1].pads == 1 && falls->list[2].pads == 2);
    fixture_destroy(&fixture);
}

// What sinks slowly does not fall. Within an event mu may rise before it falls, and rise again
// after: the top before the drop counts. An event under way is not yet a fall.
static void test_within_an_event(void **state)
{
    (void)state;
    Fixture fixture;
    fixture_build(&fixture);
    const Falls *falls = &fixture.falls;
    see(&fixture, 0.3, REST);
    see(&fixture, 0.1, REST);
    see(&fixture, 0.2, LEFT);
    see(&fixture, 0.31, LEFT);
    see(&fixture, 0.2, LEFT);
    see(&fixture, 0.4, LEFT);
    assert_int_equal(falls->count, 0);
    see(&fixture, 0.39, REST);
    assert_int_equal(falls->count, 1);
    assert_near("top", falls->list[0].mu, 0.31, 0);
    assert_near("after", falls->list[0].mu_after, 0.2, 0);
    fixture_destroy(&fixture);
}

// All alike: period 1, the first fall left out. The mean and the ends are over those that agree.
static void test_alike(void **state)
{
    (void)state;
    Fixture fixture;
    fixture_build(&fixture);
    assert_true(isnan(falls_summarise(&fixture.falls).low));
    fall(&fixture, 0.3, 0.1, ACROSS);
    assert_int_equal(falls_summarise(&fixture.falls).period, 0);
    fall(&fixture, 0.3, 0.1, ACROSS);
    fall(&fixture, 0.3, 0.1, ACROSS);
    assert_int_equal(falls_summarise(&fixture.falls).period, 0);   // two after the first
    fall(&fixture, 0.302, 0.1, ACROSS);
    FallsSummary found = falls_summarise(&fixture.falls);
    assert_true(found.period == 1 && found.counted == 3 && found.branch_count == 1);
    assert_near("low", found.low, 0.3, 0);
    assert_near("high", found.high, 0.302, 0);
    assert_near("mean", found.branches[0].mu, 0.902 / 3, 1e-15);
    assert_int_equal(found.branches[0].pads, 2);
    fixture_destroy(&fixture);
}

// Heights 0.3, 0.25, 0.27 by turns: period 3, seen once each has come back twice. Falls of one
// height in which other pads slide are not alike.
static void test_branches(void **state)
{
    (void)state;
    Fixture fixture;
    fixture_build(&fixture);
    fall(&fixture, 0.5, 0.1, ACROSS);
    for (int32_t k = 0; k < 7; k++) {
        assert_int_equal(falls_summarise(&fixture.falls).period, 0);
        fall(&fixture, (double[]){0.3, 0.25, 0.27}[k % 3], 0.1, k % 3 == 1 ? LEFT : ACROSS);
    }
    FallsSummary found = falls_summarise(&fixture.falls);
    assert_true(found.period == 3 && found.counted == 6 && found.branch_count == 3);
    assert_near("to trust", found.low, 0.25, 0);
    assert_near("lowest branch", found.branches[0].mu, 0.25, 1e-15);
    assert_near("middle", found.branches[1].mu, 0.27, 1e-15);
    assert_near("highest", found.branches[2].high, 0.3, 0);
    assert_true(found.branches[0].pads == 1 && found.branches[2].pads == 2);

    for (int32_t k = 0; k < 8; k++) fall(&fixture, 0.3, 0.1, k % 2 ? ACROSS : LEFT);
    assert_int_equal(falls_summarise(&fixture.falls).period, 2);
    fixture_destroy(&fixture);
}

// No period: branches by the number of pads that slid, over the last three quarters.
static void test_without_period(void **state)
{
    (void)state;
    Fixture fixture;
    fixture_build(&fixture);
    for (int32_t k = 0; k < 10; k++) fall(&fixture, 0.1, 0.05, LEFT);
    for (int32_t k = 0; k < 30; k++)
        fall(&fixture, 0.3 + 0.01 * ((7 * k * k) % 20), 0.1, k % 3 ? ACROSS : LEFT);
    FallsSummary found = falls_summarise(&fixture.falls);
    assert_int_equal(fixture.falls.count, 40);
    assert_true(found.period == 0 && found.counted == 30 && found.branch_count == 2);
    assert_near("low", found.low, 0.3, 1e-12);
    assert_int_equal(found.branches[0].count + found.branches[1].count, 30);
    int32_t left = found.branches[0].pads == 1 ? 0 : 1;
    assert_int_equal(found.branches[left].count, 10);
    double sum = 0;
    for (int32_t k = 0; k < 30; k += 3) sum += 0.3 + 0.01 * ((7 * k * k) % 20);
    assert_near("mean", found.branches[left].mu, sum / 10, 1e-12);
    // By numpy: mean, std(ddof=1), quantile(0.1) of these 30, and five blocks of six.
    assert_near("of all", found.mean, 0.375, 1e-9);
    assert_near("its error", found.mean_error, 0.00818956442781, 1e-9);
    assert_near("to trust", found.trusted, 0.327, 1e-9);
    assert_near("its error", found.trusted_error, 0.015, 1e-9);
    assert_false(found.enough);   // 30 of them, but the mean is known to 2.2 % only
    assert_false(falls_are_settled(&fixture.falls));
    for (int32_t k = 30; k < 80; k++)
        fall(&fixture, 0.3 + 0.01 * ((7 * k * k) % 20), 0.1, k % 3 ? ACROSS : LEFT);
    assert_true(falls_summarise(&fixture.falls).enough && falls_are_settled(&fixture.falls));
    fixture_destroy(&fixture);
}

// Three falls of forty agree by chance; to repeat they must be a third of the run.
static void test_chance_is_no_period(void **state)
{
    (void)state;
    Fixture fixture;
    fixture_build(&fixture);
    for (int32_t k = 0; k < 7; k++) fall(&fixture, 0.3 + 0.02 * k * k, 0.1, ACROSS);
    for (int32_t k = 0; k < 3; k++) fall(&fixture, 0.7, 0.1, ACROSS);
    assert_int_equal(falls_summarise(&fixture.falls).period, 0);   // 3 of 10
    fall(&fixture, 0.7, 0.1, ACROSS);
    assert_int_equal(falls_summarise(&fixture.falls).period, 1);   // 4 of 11
    fixture_destroy(&fixture);
}

static void test_memory_faults(void **state)
{
    (void)state;
    Fixture fixture;
    fixture_build(&fixture);
    Error err = {0};
    Falls falls;
    int64_t live = memory_counters().live;
    memory_fail_after(0);
    assert_false(falls_create(&fixture.run.events, &fixture.pads, 1e-2, &falls, &err));
    memory_fail_after(-1);
    assert_int_equal(err.code, ERROR_MEMORY);
    falls_destroy(&falls);
    assert_int_equal(memory_counters().live, live);
    for (int32_t k = 0; k < 16; k++) fall(&fixture, 0.3, 0.1, ACROSS);
    err = (Error){0};
    memory_fail_after(0);   // the list is full: the next fall needs room
    fixture.run.hand.seen.mu = 0.3;
    falls_record(&fixture.falls, hand_seen(&fixture.run.hand, 900, REST), &err);
    fixture.run.events.ended = true;
    fixture.run.hand.seen.mu = 0.1;
    assert_false(falls_record(&fixture.falls, hand_seen(&fixture.run.hand, 901, REST), &err));
    memory_fail_after(-1);
    assert_int_equal(err.code, ERROR_MEMORY);
    assert_int_equal(fixture.falls.count, 16);
    fixture_destroy(&fixture);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_which_count),
        cmocka_unit_test(test_within_an_event),
        cmocka_unit_test(test_alike),
        cmocka_unit_test(test_branches),
        cmocka_unit_test(test_without_period),
        cmocka_unit_test(test_memory_faults),
        cmocka_unit_test(test_chance_is_no_period),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
