// SPDX-License-Identifier: GPL-2.0-or-later
// The contact in segments: how nodes are shared out, what each carries, how far it lags behind.
#include "record/segments.h"

#include "base/memory.h"
#include "plane.h"
#include "seen_by_hand.h"

TEST(test_state)
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
