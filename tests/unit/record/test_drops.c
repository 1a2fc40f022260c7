// SPDX-License-Identifier: GPL-2.0-or-later
// Made-up force curves: which events are drops, of which kinds, and what each drop holds.
#include "record/drops.h"

#include "base/memory.h"
#include "drops_by_hand.h"
#include "plane.h"
#include "seen_by_hand.h"

// Which drops of mu are load drops depends on their size relative to mu alone, whoever slips and at
// whatever load.
TEST(test_least_drop)
{
    const double near = 0.01;
    for (double mu = 0.01; mu < 2; mu *= 7) {
        HandDrops hand;
        hand_drops_begin(&hand, 2);
        drop(&hand, mu, mu * (1 - (1 - near) * LEAST_DROP), PART);
        assert_int_equal(hand.drops.count, 0);
        drop(&hand, mu, mu * (1 - (1 + near) * LEAST_DROP), PART);
        assert_int_equal(hand.drops.count, 1);
        assert_true(drop_is(&hand.drops.list[0], DROP_LOAD));
        assert_false(drop_is(&hand.drops.list[0], DROP_PADS));
        assert_false(drop_is(&hand.drops.list[0], DROP_BULK));
        hand_drops_end(&hand);
    }
}

// Where pads or the whole block slide it is a drop even if mu hardly falls; a bulk sliding is a
// load drop then, too.
TEST(test_kinds)
{
    HandDrops hand;
    hand_drops_begin(&hand, 2);
    drop(&hand, 0.3, 0.299, LEFT);
    drop(&hand, 0.3, 0.299, ACROSS);
    drop(&hand, 0.3, 0.1, LEFT);
    drop(&hand, 0.3, 0.1, PART);
    drop(&hand, 0.3, 0.299, PART);
    assert_int_equal(hand.drops.count, 4);
    assert_int_equal(drops_count(&hand.drops, DROP_BULK), 1);
    assert_int_equal(drops_count(&hand.drops, DROP_LOAD), 3);
    assert_int_equal(drops_count(&hand.drops, DROP_PADS), 3);
    const int32_t pads[] = {1, 2, 1, 0};
    for (int32_t k = 0; k < 4; k++) {
        const Drop *found = &hand.drops.list[k];
        assert_int_equal(found->pads, pads[k]);
        const uint8_t *slid = &hand.drops.slid[2 * k];   // LEFT is all of the left pad
        assert_true(slid[0] == (k < 3) && slid[1] == (k == 1));
        assert_int_equal(hand.run.events.list[found->event].kind,
                         k == 1 ? EVENT_LEADING : EVENT_BOUNDED);
    }
    assert_true(hand.drops.list[1].bulk && hand.drops.list[1].load);
    assert_near("largest", hand.drops.mu_max, 0.3, 0);
    hand_drops_end(&hand);
}

// A block that moves at t = 0 slides without having held anything; from its first rest on all is as
// ever.
TEST(test_moving_at_the_start)
{
    for (int32_t part = 0; part < 2; part++) {
        HandDrops hand;
        hand_drops_begin(&hand, 2);
        for (int32_t k = 0; k < 4; k++) see(&hand, 0.3 - 0.1 * k, part ? LEFT : ACROSS);
        see(&hand, 0, REST);
        assert_int_equal(hand.run.events.count, 1);
        assert_int_equal(hand.drops.count, 0);
        drop(&hand, 0.2, 0.1, ACROSS);
        assert_int_equal(hand.drops.count, 1);
        assert_near("mu", hand.drops.list[0].mu, 0.2, 0);
        hand_drops_end(&hand);
    }
}

// A drop of one kind holds the largest mu since the last one of its kind.
TEST(test_since_the_last_of_its_kind)
{
    HandDrops hand;
    hand_drops_begin(&hand, 2);
    drop(&hand, 0.5, 0.1, ACROSS);   // t = 0 to 4
    drop(&hand, 0.4, 0.399, LEFT);
    drop(&hand, 0.3, 0.1, PART);
    drop(&hand, 0.35, 0.1, ACROSS);   // t = 15 to 19
    Drop peak = drops_as(&hand.drops, DROP_BULK, 3), load = drops_as(&hand.drops, DROP_LOAD, 3);
    Drop of_pads = drops_as(&hand.drops, DROP_PADS, 3);
    assert_near("since the bulk sliding", peak.mu, 0.4, 0);
    assert_near("where", peak.U, 0.6, 1e-15);
    assert_near("since the load drop", load.mu, 0.35, 0);
    assert_near("since a pad slid", of_pads.mu, 0.399, 0);
    assert_near("list", hand.drops.list[3].mu, 0.35, 0);
    hand_drops_end(&hand);
}

// l_c is how far slow slip had come from the trailing end. Where the nodes there are open, or stick
// while slip begins elsewhere, it is not known; slip behind an open node counts.
TEST(test_no_critical_length)
{
    HandDrops hand;
    hand_drops_begin(&hand, 1);
    hand.run.hand.open[0] = true;
    see(&hand, 0.2, REST);
    see(&hand, 0.3, (double[]){0, 0, 0, 0.5, 0.5});
    see(&hand, 0.3, ACROSS);
    see(&hand, 0.1, REST);
    assert_true(isnan(hand.drops.list[0].critical_length));
    see(&hand, 0.3, (double[]){0, 0.5, 0, 0, 0});
    see(&hand, 0.3, ACROSS);
    see(&hand, 0.1, REST);
    assert_near("behind it", hand.drops.list[1].critical_length, 0.25, 0);
    hand_drops_end(&hand);
}

// So it does the first fronts, on a contact without gaps.
TEST(test_fronts_since_the_last_of_its_kind)
{
    HandDrops hand;
    hand_drops_begin(&hand, 1);
    drop(&hand, 0.5, 0.1, ACROSS);
    hand.run.hand.seen.certified = false;
    drop(&hand, 0.3, 0.1, PART);
    hand.run.hand.seen.certified = true;
    hand.run.hand.seen.grows = true;
    drop(&hand, 0.35, 0.1, ACROSS);
    Drop peak = drops_as(&hand.drops, DROP_BULK, 2), load = drops_as(&hand.drops, DROP_LOAD, 2);
    assert_near("l_sc", peak.front_uncertified, 0, 0);   // at rest
    assert_near("l_c from the rates", peak.front_growth, 0, 0);
    assert_near("l_c", peak.critical_length, 0.25, 0);
    assert_true(isnan(load.front_uncertified));
    hand_drops_end(&hand);
}

// On pads the place of a front is no length of slip: l_c is how much of the pad slipped on which
// slow slip turned fast, and other fronts are not looked at. The second event begins on the right
// pad, of which a node that weighs 1/8 slipped.
TEST(test_slip_on_pads)
{
    HandDrops hand;
    hand_drops_begin(&hand, 2);
    hand.run.hand.seen.certified = false;
    hand.run.hand.seen.grows = true;
    drop(&hand, 0.5, 0.1, ACROSS);
    assert_near("l_c", hand.drops.list[0].critical_length, 0.375, 1e-15);
    see(&hand, 0.2, (double[]){0.5, 0, 0, 0, 0.5});
    see(&hand, 0.4, (double[]){0.5, 0, 0, 3, 3});
    see(&hand, 0.1, ACROSS);
    see(&hand, 0.1, REST);
    drop(&hand, 0.4, 0.1, ACROSS);
    assert_int_equal(hand.drops.count, 3);
    for (int32_t k = 0; k < 3; k++)
        assert_true(isnan(hand.drops.list[k].front_uncertified + hand.drops.list[k].front_growth));
    assert_near("l_c", hand.drops.list[1].critical_length, 0.125, 1e-15);
    hand_drops_end(&hand);
}

// A slow decrease is no drop. Within an event mu may rise before it falls, and rise again
// after: the top before the fall counts. A drop that is not a bulk sliding is known when its event
// has ended.
TEST(test_within_an_event)
{
    HandDrops hand;
    hand_drops_begin(&hand, 2);
    see(&hand, 0.3, REST);
    see(&hand, 0.1, REST);
    see(&hand, 0.2, LEFT);
    see(&hand, 0.31, LEFT);
    see(&hand, 0.2, LEFT);
    see(&hand, 0.4, LEFT);
    assert_int_equal(hand.drops.count, 0);
    see(&hand, 0.39, REST);
    assert_int_equal(hand.drops.count, 1);
    assert_near("top", hand.drops.list[0].mu, 0.31, 0);
    assert_near("after", hand.drops.list[0].mu_after, 0.2, 0);
    hand_drops_end(&hand);
}

// A bulk sliding is known when it has crossed the interface; whatever mu does then is no peak.
TEST(test_bulk_sliding)
{
    HandDrops hand;
    hand_drops_begin(&hand, 1);
    see(&hand, 0.2, REST);
    hand.run.hand.seen.certified = false;
    see(&hand, 0.4, SLOW);   // t = 1
    see(&hand, 0.39, PART);
    assert_int_equal(hand.drops.count, 0);
    hand.run.hand.seen.grows = true;
    see(&hand, 0.385, ACROSS);
    assert_int_equal(hand.drops.count, 1);
    const Drop *peak = &hand.drops.list[0];
    assert_near("mu", peak->mu, 0.4, 0);
    assert_near("U", peak->U, 0.1, 1e-15);
    assert_near("l_c", peak->critical_length, 0.25, 0);
    assert_near("l_sc", peak->front_uncertified, 0.25, 0);
    assert_near("l_c from the rates", peak->front_growth, 1, 0);   // seen while it crossed
    see(&hand, 0.8, ACROSS);
    see(&hand, 0.1, ACROSS);
    hand.run.hand.seen.grows = false;
    hand.run.hand.seen.certified = true;
    see(&hand, 0.15, REST);
    assert_int_equal(hand.drops.count, 1);
    assert_near("mu", peak->mu, 0.4, 0);
    assert_near("after", peak->mu_after, 0.1, 0);
    assert_near("largest", hand.drops.mu_max, 0.8, 0);
    drop(&hand, 0.3, 0.1, ACROSS);
    assert_near("next", hand.drops.list[1].mu, 0.3, 0);
    assert_true(isnan(hand.drops.list[1].front_uncertified));
    hand_drops_end(&hand);
}

// An event that begins in the step after another has ended falls from where that one ended.
TEST(test_one_event_after_the_other)
{
    HandDrops hand;
    hand_drops_begin(&hand, 2);
    drop(&hand, 0.5, 0.3, PART);   // ends at 0.3
    see(&hand, 0.2, PART);
    see(&hand, 0.2, REST);
    assert_int_equal(hand.drops.count, 2);
    assert_near("mu", hand.drops.list[1].mu, 0.3, 0);
    assert_near("after", hand.drops.list[1].mu_after, 0.2, 0);
    see(&hand, 0.199, PART);   // not from 0.5: no drop
    see(&hand, 0.199, REST);
    assert_int_equal(hand.drops.count, 2);
    hand_drops_end(&hand);
}

// A rod that pulls, or none.
TEST(test_no_load)
{
    HandDrops hand;
    hand_drops_begin(&hand, 2);
    drop(&hand, 0, 0, PART);
    drop(&hand, -0.1, -0.3, PART);
    assert_int_equal(hand.drops.count, 0);
    hand_drops_end(&hand);
}

TEST(test_memory_faults)
{
    Error err = {0};
    HandDrops hand;
    hand_drops_begin(&hand, 2);
    int64_t live = memory_counters().live;
    for (int32_t k = 0; k < 6; k++) {
        Drops drops;
        memory_fail_after(k);
        assert_false(drops_create(&hand.run.hand.interface, &hand.run.events, 1e-2, &drops, &err));
        memory_fail_after(-1);
        assert_int_equal(err.code, ERROR_MEMORY);
        error_clear(&err);
        drops_destroy(&drops);
        assert_int_equal(memory_counters().live, live);
    }
    while (hand.drops.count < hand.drops.room) drop(&hand, 0.3, 0.1, ACROSS);
    int32_t full = hand.drops.count;
    for (int32_t k = 0; k < 3; k++) {   // the next drop needs room, three times
        see(&hand, 0.3, REST);
        const Observation *seen = hand_seen(&hand.run.hand, hand.run.time++, ACROSS);
        assert_true(events_record(&hand.run.events, seen, &err));
        memory_fail_after(k);
        assert_false(drops_record(&hand.drops, seen, &err));
        memory_fail_after(-1);
        assert_int_equal(err.code, ERROR_MEMORY);
        error_clear(&err);
        assert_int_equal(hand.drops.count, full);
        see(&hand, 0.1, REST);
    }
    for (int32_t k = 0; k < 100; k++) drop(&hand, 0.3 + 1e-3 * k, 0.1, ACROSS);
    assert_int_equal(hand.drops.count, full + 100);
    for (int32_t k = 0; k < 100; k++)
        assert_near("mu", hand.drops.list[full + k].mu, 0.3 + 1e-3 * k, 0);
    hand_drops_end(&hand);
}

// --- the contact in segments: how nodes are shared out ------------------------------------------

TEST(test_state_of_segments)
{
    Error err = {0};
    HandSeen hand;
    Segments segments;
    double found[2 * SEEN_NODES];
    hand_seen_init(&hand);
    hand_split(&hand, 2);
    assert_true(segments_create(&hand.interface, &segments, &err));
    assert_int_equal(segments.count, SEEN_NODES);   // fewer nodes than segments: each is one
    for (int32_t i = 0; i < SEEN_NODES; i++) {
        hand.reaction[plane_normal(i)] = 2;
        hand.reaction[plane_tangent(i)] = -0.1 * i;
    }
    const Observation *seen = hand_seen(&hand, 10, (double[]){1, 1, 1, 0, 0});   // U = 1
    segments_read(&segments, seen, found);
    for (int32_t s = 0; s < SEEN_NODES; s++) {
        assert_near("share", found[s], 0.01 * s, 1e-15);
        assert_near("lag", found[SEEN_NODES + s], s < 3 ? 0 : 1, 1e-15);
    }
    segments_follow(&segments, seen);
    assert_int_equal(segments.stuck, 2);
    segments_follow(&segments, hand_seen(&hand, 11, (double[]){0, 1, 0, 1, 1}));
    assert_int_equal(segments.stuck, 0);
    segments_destroy(&segments);
    segments_destroy(&segments);
}

// 200 nodes on a long pad, 20 on a short one, 1 on a third: parts with as many nodes each, and no
// pad without.
TEST(test_shared_out)
{
    enum { NODES = 221 };
    Error err = {0};
    Segments segments;
    int32_t pad[NODES];
    for (int32_t i = 0; i < NODES; i++) pad[i] = i < 200 ? 0 : (i < 220 ? 1 : 2);
    Interface interface = {.dim = 2, .contact_count = NODES, .pad = pad, .pad_count = 3};
    int64_t live = memory_counters().live;
    assert_true(segments_create(&interface, &segments, &err));
    assert_int_equal(segments.count, 14 + 1 + 1);
    for (int32_t s = 0; s < 14; s++)
        assert_in_range((int32_t)segments.nodes[s], 14, 15);   // 200 / 14
    assert_near("short", segments.nodes[14], 20, 0);
    assert_near("a node", segments.nodes[15], 1, 0);
    for (int32_t i = 1; i < NODES; i++)
        assert_in_range(segments.of_node[i] - segments.of_node[i - 1], 0, 1);
    segments_destroy(&segments);
    for (int32_t k = 0; k < 3; k++) {
        memory_fail_after(k);
        assert_false(segments_create(&interface, &segments, &err));
        memory_fail_after(-1);
        error_clear(&err);
        segments_destroy(&segments);
        assert_int_equal(memory_counters().live, live);
    }
}

// --- the drops of one kind as a series ----------------------------------------------------------

// There are two bulk slidings, three load drops, and three of pads.
TEST(test_series_of_a_kind)
{
    HandDrops hand;
    hand_drops_begin(&hand, 2);
    drop(&hand, 0.5, 0.1, ACROSS);
    drop(&hand, 0.4, 0.399, LEFT);
    drop(&hand, 0.3, 0.1, PART);
    drop(&hand, 0.35, 0.1, ACROSS);
    assert_int_equal(drops_series(&hand.drops, DROP_BULK, 0), 2);
    assert_near("series", hand.drops.series[1].value, 0.4, 0);
    assert_int_equal(hand.drops.series[1].kind, 2);
    assert_int_equal(drops_series(&hand.drops, DROP_LOAD, 0), 3);
    assert_near("series", hand.drops.series[1].value, 0.4, 0);
    assert_int_equal(drops_series(&hand.drops, DROP_PADS, 2), 1);
    hand_drops_end(&hand);
}

// The second event begins on the right pad, of which a node that weighs 1/8 slipped. Only drops
// from a given one on are asked.
TEST(test_least_resolved)
{
    HandDrops hand;
    hand_drops_begin(&hand, 2);
    assert_null(drops_least_resolved(&hand.drops, 0));
    drop(&hand, 0.5, 0.1, ACROSS);
    see(&hand, 0.2, (double[]){0.5, 0, 0, 0, 0.5});
    see(&hand, 0.4, (double[]){0.5, 0, 0, 3, 3});
    see(&hand, 0.1, ACROSS);
    see(&hand, 0.1, REST);
    drop(&hand, 0.4, 0.1, ACROSS);
    const Event *least = drops_least_resolved(&hand.drops, 0);
    assert_non_null(least);
    assert_true(least->pad == 1);
    assert_near("cells", least->slip_cells, 0.5, 0);
    least = drops_least_resolved(&hand.drops, 2);
    assert_non_null(least);
    assert_true(least->pad == 0);
    assert_near("cells", least->slip_cells, 1.5, 0);
    hand_drops_end(&hand);
}
