// SPDX-License-Identifier: GPL-2.0-or-later
// Made-up force curves: the drops of one kind as a series, and which of them was resolved worst.
#include "answers/drop_series.h"

#include "drops_by_hand.h"

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
