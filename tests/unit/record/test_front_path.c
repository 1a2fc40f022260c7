// SPDX-License-Identifier: GPL-2.0-or-later
// A front that runs past made-up nodes: arrivals and speeds against the motion they were made from.
#include "record/front_path.h"

#include "base/memory.h"
#include "seen_by_hand.h"

static const double THRESHOLD = 2;

// A node at x speeds up by 1 a unit of time from when the front (speed c, at 0 when t = 0) reaches
// it: it passes the threshold 2 later. What is linear in a step is found exactly.
static void see_front(HandSeen *hand, FrontPath *path, double t, double c)
{
    double rate[SEEN_NODES];
    for (int32_t i = 0; i < SEEN_NODES; i++) rate[i] = fmax(t - hand->x[i] / c, 0);
    const Observation *seen = hand_seen(hand, t, rate);
    front_path_follow(path, seen);
    front_path_keep(path, seen);
}

TEST(test_a_steady_front)
{
    Error err = {0};
    HandSeen hand;
    FrontPath path;
    double times[FRONT_STATIONS], c = 0.125;   // past a node every 2
    hand_seen_init(&hand);
    assert_true(front_path_create(&hand.interface, THRESHOLD, &path, &err));
    for (double t = 0.3; t <= 12; t += 1) see_front(&hand, &path, t, c);
    front_path_stations(&path, 0, times);
    for (int32_t k = 0; k < FRONT_STATIONS; k++)
        assert_near("arrival", times[k], THRESHOLD + k / 20.0 / c, 1e-12);
    for (int32_t k = 0; k + 1 < FRONT_STATIONS; k++)
        assert_near("speed", front_path_speed(&path, times, k), c, 1e-12);
    front_path_stations(&path, 1.5, times);
    assert_near("after its origin", times[0], 0.5, 1e-12);
    front_path_destroy(&path);
    front_path_destroy(&path);
}

// Between nodes 2 and 3, at x = 0.5 and 0.75, there is no contact: no time there, and no speed
// across. On either side all is as without a gap.
TEST(test_a_gap)
{
    Error err = {0};
    HandSeen hand;
    FrontPath path;
    double times[FRONT_STATIONS], c = 0.125;
    hand_seen_init(&hand);
    hand_split(&hand, 2);
    assert_true(front_path_create(&hand.interface, THRESHOLD, &path, &err));
    for (double t = 0.3; t <= 12; t += 1) see_front(&hand, &path, t, c);
    front_path_stations(&path, 0, times);
    for (int32_t k = 0; k < FRONT_STATIONS; k++) {
        bool in_gap = k > 10 && k < 15;
        assert_int_equal(isnan(times[k]), in_gap);
        if (!in_gap) assert_near("arrival", times[k], THRESHOLD + k / 20.0 / c, 1e-12);
    }
    for (int32_t k = 0; k + 1 < FRONT_STATIONS; k++) {
        bool over_gap = k >= 10 && k < 15;
        assert_int_equal(isnan(front_path_speed(&path, times, k)), over_gap);
        if (!over_gap) assert_near("speed", front_path_speed(&path, times, k), c, 1e-12);
    }
    front_path_destroy(&path);
}

// Nodes 0 to 2 pass, the others never: stations up to x = 0.5 have a time, none beyond.
TEST(test_a_front_that_stops)
{
    Error err = {0};
    HandSeen hand;
    FrontPath path;
    double times[FRONT_STATIONS];
    const double fast[] = {4, -4, 3, 1.9, 0}, rest[SEEN_NODES] = {0};
    hand_seen_init(&hand);
    assert_true(front_path_create(&hand.interface, THRESHOLD, &path, &err));
    front_path_keep(&path, hand_seen(&hand, 10, rest));
    front_path_follow(&path, hand_seen(&hand, 11, fast));
    front_path_stations(&path, 10, times);
    assert_near("0 to 4 passes 2 half way", times[0], 0.5, 1e-12);
    assert_near("so does 0 to -4", times[5], 0.5, 1e-12);
    assert_near("0 to 3", times[10], 2.0 / 3, 1e-12);
    for (int32_t k = 11; k < FRONT_STATIONS; k++) assert_true(isnan(times[k]));
    assert_true(isnan(front_path_speed(&path, times, 0)));   // both stations at once
    assert_true(isnan(front_path_speed(&path, times, 10)));
    assert_near("speed", front_path_speed(&path, times, 9), 0.05 / (times[10] - times[9]), 1e-12);
    front_path_restart(&hand.interface, &path);
    front_path_stations(&path, 0, times);
    for (int32_t k = 0; k < FRONT_STATIONS; k++) assert_true(isnan(times[k]));
    front_path_destroy(&path);
}

// In the first step there is nothing to interpolate from; a node that was fast before arrives with
// the step in which it is asked for.
TEST(test_no_step_before)
{
    Error err = {0};
    HandSeen hand;
    FrontPath path;
    const double fast[] = {3, 3, 3, 3, 3};
    hand_seen_init(&hand);
    assert_true(front_path_create(&hand.interface, THRESHOLD, &path, &err));
    front_path_follow(&path, hand_seen(&hand, 7, fast));
    for (int32_t i = 0; i < SEEN_NODES; i++) assert_true(path.arrival[i] == 7);
    front_path_keep(&path, hand_seen(&hand, 8, fast));
    front_path_restart(&hand.interface, &path);
    front_path_follow(&path, hand_seen(&hand, 9, fast));
    for (int32_t i = 0; i < SEEN_NODES; i++) assert_true(path.arrival[i] == 9);
    front_path_destroy(&path);
}

TEST(test_memory)
{
    HandSeen hand;
    hand_seen_init(&hand);
    int64_t live = memory_counters().live;
    for (int64_t k = 0; k < 2; k++) {
        Error err = {0};
        FrontPath path;
        memory_fail_after(k);
        assert_false(front_path_create(&hand.interface, THRESHOLD, &path, &err));
        memory_fail_after(-1);
        assert_int_equal(err.code, ERROR_MEMORY);
        front_path_destroy(&path);
        assert_int_equal(memory_counters().live, live);
    }
}
