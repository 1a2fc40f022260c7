// SPDX-License-Identifier: GPL-2.0-or-later
// The contact in stretches: how nodes are shared out, what each carries, how far it lags behind.
#include "record/stretches.h"

#include "base/memory.h"
#include "plane.h"
#include "seen_by_hand.h"

TEST(test_state)
{
    Error err = {0};
    HandSeen hand;
    Stretches stretches;
    double found[2 * SEEN_NODES];
    hand_seen_init(&hand);
    hand_split(&hand, 2);
    assert_true(stretches_create(&hand.interface, &stretches, &err));
    assert_int_equal(stretches.count, SEEN_NODES);   // fewer nodes than stretches: each is one
    for (int32_t i = 0; i < SEEN_NODES; i++) {
        hand.reaction[plane_normal(i)] = 2;
        hand.reaction[plane_tangent(i)] = -0.1 * i;
    }
    const Observation *seen = hand_seen(&hand, 10, (double[]){1, 1, 1, 0, 0});   // U = 1
    stretches_read(&stretches, seen, found);
    for (int32_t s = 0; s < SEEN_NODES; s++) {
        assert_near("share", found[s], 0.01 * s, 1e-15);
        assert_near("lag", found[SEEN_NODES + s], s < 3 ? 0 : 1, 1e-15);
    }
    stretches_follow(&stretches, seen);
    assert_int_equal(stretches.stuck, 2);
    stretches_follow(&stretches, hand_seen(&hand, 11, (double[]){0, 1, 0, 1, 1}));
    assert_int_equal(stretches.stuck, 0);
    stretches_destroy(&stretches);
    stretches_destroy(&stretches);
}

// 200 nodes on a long pad, 20 on a short one, 1 on a third: parts with as many nodes each, and no
// pad without.
TEST(test_shared_out)
{
    enum { NODES = 221 };
    Error err = {0};
    Stretches stretches;
    int32_t pad[NODES];
    for (int32_t i = 0; i < NODES; i++) pad[i] = i < 200 ? 0 : (i < 220 ? 1 : 2);
    Interface interface = {.dim = 2, .contact_count = NODES, .pad = pad, .pad_count = 3};
    int64_t live = memory_counters().live;
    assert_true(stretches_create(&interface, &stretches, &err));
    assert_int_equal(stretches.count, 14 + 1 + 1);
    for (int32_t s = 0; s < 14; s++)
        assert_in_range((int32_t)stretches.nodes[s], 14, 15);   // 200 / 14
    assert_near("short", stretches.nodes[14], 20, 0);
    assert_near("a node", stretches.nodes[15], 1, 0);
    for (int32_t i = 1; i < NODES; i++)
        assert_in_range(stretches.of_node[i] - stretches.of_node[i - 1], 0, 1);
    stretches_destroy(&stretches);
    for (int32_t k = 0; k < 3; k++) {
        memory_fail_after(k);
        assert_false(stretches_create(&interface, &stretches, &err));
        memory_fail_after(-1);
        error_clear(&err);
        stretches_destroy(&stretches);
        assert_int_equal(memory_counters().live, live);
    }
}
