// SPDX-License-Identifier: GPL-2.0-or-later
// Made-up sequences of steps, and the events that stand in them. Rapid is above 2, over below 1.
#include "record/events.h"

#include "base/memory.h"
#include "seen_by_hand.h"

static HandSeen hand;
static Events events;

FIXTURE(setup)
{
    Error err = {0};
    hand_seen_init(&hand);
    return events_create(&hand.interface, 1, &events, &err) ? 0 : 1;
}

FIXTURE(teardown)
{
    events_destroy(&events);
    events_destroy(&events);
    return 0;
}

static void split(int32_t pads)
{
    Error err = {0};
    events_destroy(&events);
    hand_split(&hand, pads);
    assert_true(events_create(&hand.interface, 1, &events, &err));
}

static void see(double t, double a, double b, double c, double d, double e)
{
    Error err = {0};
    double rate[] = {a, b, c, d, e};
    assert_true(events_record(&events, hand_seen(&hand, t, rate), &err));
}

static void expect_flags(bool began, bool ended, bool crossed)
{
    assert_int_equal(events.began, began);
    assert_int_equal(events.ended, ended);
    assert_int_equal(events.crossed, crossed);
}

static void expect_event(int32_t k, EventKind kind, double t_start, double t_stop, double reach)
{
    const Event *event = &events.list[k];
    assert_int_equal(event->kind, kind);
    assert_near("t_start", event->t_start, t_start, 1e-15);
    assert_near("U_start", event->U_start, t_start / 10, 1e-15);
    assert_near("t_stop", event->t_stop, t_stop, 1e-15);
    assert_near("U_stop", event->U_stop, t_stop / 10, 1e-15);
    assert_near("reach", event->reach, reach, 1e-15);
}

static void expect_kinds(int32_t slow, int32_t bounded, int32_t leading)
{
    assert_int_equal(events.kinds[EVENT_QUASI_STATIC], slow);
    assert_int_equal(events.kinds[EVENT_BOUNDED], bounded);
    assert_int_equal(events.kinds[EVENT_LEADING], leading);
    assert_int_equal(events.count, slow + bounded + leading);
}

// The front goes from 0 over 0.25 to 0.75 in 20: one slow event, open until it is closed.
TEST_BETWEEN(test_slow, setup, teardown)
{
    see(0, 0, 0, 0, 0, 0);
    see(5, 0.5, 0, 0, 0, 0);   // the first node alone is no front yet
    expect_kinds(0, 0, 0);
    see(10, 0.9, 0.8, 0, 0, 0);
    see(20, 0.9, 0.8, 0.7, 0, 0);
    see(30, 1.9, 0.8, 0.7, 0.1, 0);   // faster than the rod, but not rapid
    expect_kinds(1, 0, 0);
    expect_flags(false, false, false);
    events_close(&events, &hand.seen);
    expect_event(0, EVENT_QUASI_STATIC, 10, 30, 0.75);
    assert_near("start", events.list[0].front_start, 0, 0);   // in the step before
    assert_near("front speed", events.list[0].front_speed, 0.75 / 20, 1e-15);
    assert_near("peak rate", events.list[0].peak_slip_rate, 1.9, 0);
    assert_int_equal(events.slow, -1);
    assert_string_equal(event_name(EVENT_QUASI_STATIC), "quasi-static");
}

// A rapid event within slow growth: begins above 2, goes on between 2 and 1, ends below 1.
TEST_BETWEEN(test_bounded, setup, teardown)
{
    see(1, 0.5, 0.5, 0, 0, 0);
    see(2, 5, 0.5, 0, 0, 0);
    expect_flags(true, false, false);
    see(3, 0.2, 7, 3, 0, 0);
    expect_flags(false, false, false);
    see(4, 0, 0, 4, 0, 0);   // what has stopped counts as reached
    see(5, 1.5, 1.5, 0.2, 0.1, 0);
    assert_true(events.rapid >= 0);
    see(6, 0.9, 0.9, 0, 0, 0);
    expect_flags(false, true, false);
    see(7, 0.9, 0.9, 0.5, 0, 0);
    expect_flags(false, false, false);
    expect_kinds(1, 1, 0);
    expect_event(1, EVENT_BOUNDED, 2, 6, 0.75);
    assert_near("peak rate", events.list[1].peak_slip_rate, 7, 0);
    assert_near("front before", events.list[1].front_start, 0.25, 0);
    assert_int_equal(events.slow, 0);   // the slow one is still the same
    events_close(&events, &hand.seen);
    expect_event(0, EVENT_QUASI_STATIC, 1, 7, 0.5);
}

// The fast front starts at node 1 at t = 2 and is at node 3 when the reach last grew, at t = 4.
TEST_BETWEEN(test_front_speed, setup, teardown)
{
    see(1, 0.5, 0.5, 0, 0, 0);
    see(2, 3, 3, 0, 0, 0);
    see(3, 3, 3, 3, 0, 0);
    see(4, 3, 3, 3, 3, 0);
    see(5, 3, 3, 3, 3, 0);
    see(6, 0.5, 0.5, 0, 0, 0);
    assert_near("speed", events.list[1].front_speed, 0.5 / 2, 1e-15);
    see(7, 3, 0, 0, 0, 0);   // a second one, which does not move
    see(8, 0.5, 0, 0, 0, 0);
    assert_true(isnan(events.list[2].front_speed));
}

// On pads of nodes 0 to 2, and 3 and 4: the slow front passes the gap of 0.25, and the fast one is
// followed on the second pad, where slip turned fast while the first one only creeps.
TEST_BETWEEN(test_front_speed_on_pads, setup, teardown)
{
    split(2);
    see(0, 0, 0, 0, 0, 0);
    see(10, 0.9, 0.8, 0, 0, 0);
    see(20, 0.9, 0.8, 0.7, 0.1, 0);
    see(21, 0.9, 0.8, 0.7, 3, 0);
    see(23, 0.9, 2.5, 2.5, 3, 4);
    see(24, 0, 0, 0, 0, 0);
    expect_kinds(1, 0, 1);
    assert_near("slow", events.list[0].front_speed, (0.75 - 0.25) / 10, 1e-15);
    assert_near("fast", events.list[1].front_speed, 0.25 / 2, 1e-15);
}

// How much slips on the pad where slow slip turns fast: nodes weigh 1/8, 1/4, 1/4, 1/4, 1/8, and an
// end of a pad is half a cell. On the second pad slip comes from its leading end.
TEST_BETWEEN(test_slip_length, setup, teardown)
{
    split(2);
    see(1, 0.5, 0.5, 0, 0, 0.5);
    see(2, 3, 0.5, 0.5, 0.5, 0.5);
    see(3, 0, 0, 0, 0, 0.5);
    see(4, 0.5, 0.5, 0.5, 2.5, 3);
    see(5, 0, 0, 0, 0, 0);
    see(6, 0, 0, 3, 0, 0);   // without slow slip before
    const Event *left = &events.list[1], *right = &events.list[2], *jump = &events.list[3];
    assert_true(left->pad == 0 && right->pad == 1 && jump->pad == 0);
    assert_near("left", left->slip_length, 0.375, 1e-15);
    assert_near("left", left->slip_cells, 1.5, 1e-15);
    assert_near("right", right->slip_length, 0.125, 1e-15);
    assert_near("right", right->slip_cells, 0.5, 1e-15);
    assert_true(jump->slip_length == 0 && jump->slip_cells == 0);
    assert_true(events.list[0].pad == -1 && isnan(events.list[0].slip_cells));   // slow
}

// The front passes node i when its rate rises through 2: times in closed form, from t_start = 2.
// Station 5 k stands at node k.
TEST_BETWEEN(test_front_times, setup, teardown)
{
    see(1, 0.5, 0.5, 0, 0, 0);
    see(2, 3.5, 2.5, 0, 0, 0);   // passes 2 at 1.5 and 1.75
    see(4, 3, 3, 8, 1, 0);   // at 2.5
    see(5, 0.1, 3, 9, 3, 0);   // at 4.5
    see(6, 0.5, 0.5, 0.5, 0.5, 0);
    const double *times = events.list[1].front_times;
    const double at_nodes[] = {-0.5, -0.25, 0.5, 2.5};
    for (int32_t k = 0; k < 4; k++) assert_near("time", times[5 * k], at_nodes[k], 1e-14);
    for (int32_t k = 16; k < FRONT_STATIONS; k++) assert_true(isnan(times[k]));
    assert_near("between nodes", times[7], -0.25 + 0.4 * 0.75, 1e-14);
    assert_near("speed", front_path_speed(&events.path, times, 3), 0.25 / 0.25, 1e-12);
    assert_near("speed", front_path_speed(&events.path, times, 12), 0.25 / 2, 1e-12);
    assert_true(isnan(front_path_speed(&events.path, times, 15)));
    for (int32_t k = 0; k < FRONT_STATIONS; k++) assert_true(isnan(events.list[0].front_times[k]));
    see(7, 0, 0, 5, 0, 0);   // the next event knows nothing of this one
    see(8, 0.5, 0, 0, 0, 0);
    for (int32_t k = 0; k < FRONT_STATIONS; k++)
        assert_int_equal(isnan(events.list[2].front_times[k]), k != 10);
}

// Leading when every node has slipped in the course of the event, not all at once; backward slip
// too.
TEST_BETWEEN(test_leading, setup, teardown)
{
    see(1, 0.5, 0.5, 0, 0, 0);
    see(2, 90, 90, 0, 0, 0);
    see(3, 0, 90, 90, 0, 0);
    see(4, 0, 0, 0, -90, 0);
    expect_flags(false, false, false);
    see(5, 0, 0, 0, 0, 30);
    expect_flags(false, false, true);
    expect_kinds(1, 0, 1);
    assert_int_equal(events.slow, -1);   // sliding ends the slow growth
    see(6, 50, 50, 50, 50, 50);
    expect_flags(false, false, false);   // crossed once
    see(7, 0.5, 0.5, 0.5, 0.5, 0.5);
    expect_flags(false, true, false);
    see(8, 0.5, 0.5, 0, 0, 0);
    expect_kinds(2, 0, 1);   // growth starts anew
    expect_event(0, EVENT_QUASI_STATIC, 1, 1, 0.25);
    expect_event(1, EVENT_LEADING, 2, 7, 1);
    assert_near("peak rate", events.list[1].peak_slip_rate, 90, 0);
    assert_int_equal(events.list[2].kind, EVENT_QUASI_STATIC);
}

// A block that does not stand at x = 0, slipping fast in the first step that is seen.
TEST_BETWEEN(test_first_step, setup, teardown)
{
    Error err = {0};
    events_destroy(&events);
    for (int32_t i = 0; i < SEEN_NODES; i++) hand.x[i] += 5;
    assert_true(events_create(&hand.interface, 1, &events, &err));
    see(0, 9, 9, 0, 0, 0);
    assert_near("front before", events.list[0].front_start, 5, 0);
    assert_near("reach", events.list[0].reach, 5.25, 0);
}

// Rapid slip ahead of a node that holds: the reach is without a gap.
TEST_BETWEEN(test_gap, setup, teardown)
{
    see(1, 0, 0, 0, 9, 9);
    see(2, 0.1, 0.1, 0, 9, 9);
    see(3, 0, 0, 0, 0, 0);
    expect_kinds(0, 1, 0);
    expect_event(0, EVENT_BOUNDED, 1, 3, 0.25);
}

// Nodes 3 and 4 are a pad of their own, and slide while the trailing pad holds. A third pad, whose
// first node only creeps, has no part in the event; nor has the second one, when it only creeps.
TEST_BETWEEN(test_pad_behind_one_that_sticks, setup, teardown)
{
    split(2);
    see(1, 0.1, 0, 0, 0, 0);
    see(2, 0.1, 0, 0, 9, 9);
    see(3, 0, 0, 0, 0, 0);
    expect_kinds(0, 1, 0);
    expect_event(0, EVENT_BOUNDED, 2, 3, 1);
    split(3);
    see(4, 0, 0, 0.1, 9, 0.1);
    see(5, 0, 0, 0, 0, 0);
    expect_event(0, EVENT_BOUNDED, 4, 5, 0.75);
    see(6, 3, 0.1, 0.1, 0, 0);
    see(7, 0, 0, 0, 0, 0);
    expect_event(1, EVENT_BOUNDED, 6, 7, 0.25);
}

// A node that has lifted off counts as let go.
TEST_BETWEEN(test_open_node, setup, teardown)
{
    Error err = {0};
    double rate[] = {9, 9, 9, 9, 0};
    hand_seen(&hand, 1, rate);
    hand.status[4] = CONTACT_OPEN;
    assert_true(events_record(&events, &hand.seen, &err));
    expect_kinds(0, 0, 1);
}

TEST_BETWEEN(test_run_ends_within, setup, teardown)
{
    see(1, 5, 5, 0, 0, 0);
    see(2, 5, 5, 5, 0, 0);
    hand.seen.t = 2.5;
    hand.seen.U = 0.25;
    events_close(&events, &hand.seen);
    expect_event(0, EVENT_BOUNDED, 1, 2.5, 0.5);
    assert_int_equal(events.rapid, -1);
    events_close(&events, &hand.seen);   // once more changes nothing
    expect_kinds(0, 1, 0);
}

// A precursor is slip that came to 2.5 V somewhere, and was rapid over a twentieth of
// the contact in all, or slid a whole pad. Other events are listed as slight.
TEST_BETWEEN(test_slight, setup, teardown)
{
    const double weight[] = {0.004, 0.04, 0.007, 0.5, 0.449};   // of 1
    Error err = {0};
    events_destroy(&events);
    memcpy(hand.weight, weight, sizeof weight);
    assert_true(events_create(&hand.interface, 1, &events, &err));
    see(1, 2.4, 2.4, 2.4, 2.4, 0);   // it rings about V
    see(2, 0.5, 0.5, 0.5, 0.5, 0);
    see(3, 9, 9, 0.5, 0.5, 0);   // two nodes jump where others slip slowly
    see(4, 0.5, 0, 0, 0, 0);
    assert_int_equal(events.kinds[EVENT_SLIGHT], 2);
    assert_int_equal(events.kinds[EVENT_BOUNDED], 0);
    assert_string_equal(event_name(events.list[1].kind), "slight rapid");
    see(5, 2.1, 2.1, 0, 0, 0);   // what it comes to later counts
    assert_int_equal(events.kinds[EVENT_SLIGHT], 3);
    see(6, 1.1, 2.6, 2.1, 0, 0);
    assert_int_equal(events.kinds[EVENT_SLIGHT], 2);
    assert_int_equal(events.kinds[EVENT_BOUNDED], 1);
    see(7, 0.1, 0.1, 0, 0, 0);
    see(8, 2.1, 2.1, 2.1, 2.1, 2.1);   // over all of the contact it is a sliding at any rate
    assert_int_equal(events.kinds[EVENT_LEADING], 1);
    const double light[] = {0.48, 0.48, 0, 0.02, 0.02};   // a small second pad slides
    memcpy(hand.weight, light, sizeof light);
    split(2);
    see(9, 0.1, 0, 0, 0, 9);
    assert_int_equal(events.kinds[EVENT_SLIGHT], 1);
    see(10, 0.1, 0, 0, 9, 9);
    assert_int_equal(events.kinds[EVENT_BOUNDED], 1);
}

// Slip that rings about the place where a precursor stopped, or in the middle of the contact, does
// not run from a trailing end: it has no length, and is no precursor.
TEST_BETWEEN(test_after_slip, setup, teardown)
{
    see(1, 9, 9, 9, 0, 0);
    see(2, 0, 0, 0, 0, 0);
    expect_kinds(0, 1, 0);
    see(3, 0, 0, 9, 9, 0);
    see(4, 0, 0, 0, 0, 0);
    assert_int_equal(events.kinds[EVENT_SLIGHT], 1);
    assert_int_equal(events.kinds[EVENT_BOUNDED], 1);
    expect_event(1, EVENT_SLIGHT, 3, 4, 0);
    see(5, 9, 9, 9, 9, 0);
    see(6, 0, 0, 0, 0, 0);
    assert_int_equal(events.kinds[EVENT_BOUNDED], 2);
    split(2);
    see(7, 0, 0, 0, 9, 0);   // from the trailing end of a pad
    see(8, 0, 0, 0, 0, 0);
    assert_int_equal(events.kinds[EVENT_BOUNDED], 1);
}

// Slip that begins sooner behind a precursor than that took, and stays ten times slower, rings,
// from wherever it comes; later, or faster, it is a precursor of its own.
TEST_BETWEEN(test_ringing, setup, teardown)
{
    see(0, 99, 99, 99, 0, 0);
    see(4, 0, 0, 0, 0, 0);
    see(7, 9, 9, 0, 0, 0);
    see(8, 0, 0, 0, 0, 0);
    assert_int_equal(events.kinds[EVENT_SLIGHT], 1);
    see(9, 9, 9, 0, 0, 0);
    see(10, 0, 0, 0, 0, 0);
    assert_int_equal(events.kinds[EVENT_SLIGHT], 1);
    assert_int_equal(events.kinds[EVENT_BOUNDED], 2);
    see(10.5, 99, 99, 0, 0, 0);
    see(11, 0, 0, 0, 0, 0);
    assert_int_equal(events.kinds[EVENT_BOUNDED], 3);
}

// The load of an event is that of the step before it.
TEST_BETWEEN(test_load, setup, teardown)
{
    see(1, 9, 0, 0, 0, 0);
    see(2, 0, 0, 0, 0, 0);
    assert_true(isnan(events.list[0].mu_start));
    hand.seen.mu = 0.3;
    see(3, 0, 0, 0, 0, 0);
    hand.seen.mu = 0.2;
    see(4, 9, 0, 0, 0, 0);
    assert_near("load", events.list[1].mu_start, 0.3, 0);
}

// More events than there was room for at first; none is lost, none moves.
TEST_BETWEEN(test_many, setup, teardown)
{
    for (int32_t k = 0; k < 300; k++) {
        see(2 * k, 3 + k, 0, 0, 0, 0);
        see(2 * k + 1, 0, 0, 0, 0, 0);
    }
    expect_kinds(0, 300, 0);
    for (int32_t k = 0; k < 300; k++) {
        expect_event(k, EVENT_BOUNDED, 2 * k, 2 * k + 1, 0);
        assert_near("peak rate", events.list[k].peak_slip_rate, 3 + k, 0);
    }
}

TEST_BETWEEN(test_memory_faults, setup, teardown)
{
    Error err = {0};
    int64_t live = memory_counters().live;
    for (int32_t k = 0; k < 6; k++) {
        Events made;
        memory_fail_after(k);
        assert_false(events_create(&hand.interface, 1, &made, &err));
        memory_fail_after(-1);
        assert_int_equal(err.code, ERROR_MEMORY);
        events_destroy(&made);
        error_clear(&err);
    }
    assert_int_equal(memory_counters().live, live);
    for (int32_t k = 0; k < 64; k++) {
        see(2 * k, 3, 0, 0, 0, 0);
        see(2 * k + 1, 0, 0, 0, 0, 0);
    }
    double rate[SEEN_NODES] = {3};
    memory_fail_after(0);
    assert_false(events_record(&events, hand_seen(&hand, 999, rate), &err));
    memory_fail_after(-1);
    assert_int_equal(err.code, ERROR_MEMORY);
    expect_kinds(0, 64, 0);   // what there was is still there
    Events none = {0};
    events_close(&none, &hand.seen);   // of a run that failed before it had any
}

// --- a front past made-up nodes, against its motion ---------------------------------------------

static const double THRESHOLD = 2;

// A node at x speeds up by 1 a unit of time from when the front (speed c, at 0 when t = 0) reaches
// it: it passes the threshold 2 later. What is linear in a step is found exactly.
static void see_front(HandSeen *row, FrontPath *path, double t, double c)
{
    double rate[SEEN_NODES];
    for (int32_t i = 0; i < SEEN_NODES; i++) rate[i] = fmax(t - row->x[i] / c, 0);
    const Observation *seen = hand_seen(row, t, rate);
    front_path_follow(path, seen);
    front_path_keep(path, seen);
}

TEST(test_a_steady_front)
{
    Error err = {0};
    HandSeen row;
    FrontPath path;
    double times[FRONT_STATIONS], c = 0.125;   // past a node every 2
    hand_seen_init(&row);
    assert_true(front_path_create(&row.interface, THRESHOLD, &path, &err));
    for (double t = 0.3; t <= 12; t += 1) see_front(&row, &path, t, c);
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
    HandSeen row;
    FrontPath path;
    double times[FRONT_STATIONS], c = 0.125;
    hand_seen_init(&row);
    hand_split(&row, 2);
    assert_true(front_path_create(&row.interface, THRESHOLD, &path, &err));
    for (double t = 0.3; t <= 12; t += 1) see_front(&row, &path, t, c);
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
    HandSeen row;
    FrontPath path;
    double times[FRONT_STATIONS];
    const double fast[] = {4, -4, 3, 1.9, 0}, rest[SEEN_NODES] = {0};
    hand_seen_init(&row);
    assert_true(front_path_create(&row.interface, THRESHOLD, &path, &err));
    front_path_keep(&path, hand_seen(&row, 10, rest));
    front_path_follow(&path, hand_seen(&row, 11, fast));
    front_path_stations(&path, 10, times);
    assert_near("0 to 4 passes 2 half way", times[0], 0.5, 1e-12);
    assert_near("so does 0 to -4", times[5], 0.5, 1e-12);
    assert_near("0 to 3", times[10], 2.0 / 3, 1e-12);
    for (int32_t k = 11; k < FRONT_STATIONS; k++) assert_true(isnan(times[k]));
    assert_true(isnan(front_path_speed(&path, times, 0)));   // both stations at once
    assert_true(isnan(front_path_speed(&path, times, 10)));
    assert_near("speed", front_path_speed(&path, times, 9), 0.05 / (times[10] - times[9]), 1e-12);
    front_path_restart(&row.interface, &path);
    front_path_stations(&path, 0, times);
    for (int32_t k = 0; k < FRONT_STATIONS; k++) assert_true(isnan(times[k]));
    front_path_destroy(&path);
}

// In the first step there is nothing to interpolate from; a node that was fast before arrives with
// the step in which it is asked for.
TEST(test_no_step_before)
{
    Error err = {0};
    HandSeen row;
    FrontPath path;
    const double fast[] = {3, 3, 3, 3, 3};
    hand_seen_init(&row);
    assert_true(front_path_create(&row.interface, THRESHOLD, &path, &err));
    front_path_follow(&path, hand_seen(&row, 7, fast));
    for (int32_t i = 0; i < SEEN_NODES; i++) assert_true(path.arrival[i] == 7);
    front_path_keep(&path, hand_seen(&row, 8, fast));
    front_path_restart(&row.interface, &path);
    front_path_follow(&path, hand_seen(&row, 9, fast));
    for (int32_t i = 0; i < SEEN_NODES; i++) assert_true(path.arrival[i] == 9);
    front_path_destroy(&path);
}

TEST(test_memory_of_fronts)
{
    HandSeen row;
    hand_seen_init(&row);
    int64_t live = memory_counters().live;
    for (int64_t k = 0; k < 2; k++) {
        Error err = {0};
        FrontPath path;
        memory_fail_after(k);
        assert_false(front_path_create(&row.interface, THRESHOLD, &path, &err));
        memory_fail_after(-1);
        assert_int_equal(err.code, ERROR_MEMORY);
        front_path_destroy(&path);
        assert_int_equal(memory_counters().live, live);
    }
}
