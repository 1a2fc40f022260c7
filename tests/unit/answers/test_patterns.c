// SPDX-License-Identifier: GPL-2.0-or-later
// Which pads slid, of drops by hand; and when two lists differ, by chances of Fisher's test: 4 of 8
// drops that 8 others lack are 70 / 1820 of 1.
#include "answers/patterns.h"

#include "drops_by_hand.h"

static Patterns of(uint64_t pads, int32_t drops, uint64_t others, int32_t more)
{
    Patterns patterns = {0};
    for (int32_t k = 0; k < drops; k++) patterns_add(&patterns, pads);
    for (int32_t k = 0; k < more; k++) patterns_add(&patterns, others);
    return patterns;
}

static bool differ(Patterns one, Patterns other)
{
    assert_int_equal(patterns_differ(&one, &other), patterns_differ(&other, &one));
    return patterns_differ(&one, &other);
}

TEST(test_differ)
{
    assert_true(differ(of(3, 8, 0, 0), of(3, 4, 2, 4)));   // 0.038
    assert_false(differ(of(3, 8, 0, 0), of(3, 5, 2, 3)));   // 0.1
    assert_true(differ(of(3, 16, 0, 0), of(3, 5, 2, 3)));   // 0.028
    assert_true(differ(of(3, 8, 0, 0), of(1, 8, 0, 0)));
    assert_false(differ(of(3, 7, 1, 1), of(3, 2, 1, 6)));   // both have both
    assert_false(differ(of(3, 8, 0, 0), (Patterns){0}));
    Patterns many = {0}, more = of(1000, 8, 0, 0);   // of more kinds than are listed
    for (uint64_t k = 0; k < 2 * PATTERNS_MAX; k++) patterns_add(&many, k);
    assert_true(many.count == PATTERNS_MAX && many.drops == 2 * PATTERNS_MAX);
    assert_false(patterns_differ(&many, &more));
}

TEST(test_of_drops)
{
    static const double right[] = {0, 0, 0, 9, 9};
    HandDrops hand;
    Patterns patterns = {0};
    hand_drops_begin(&hand, 2);
    drop(&hand, 0.5, 0.1, ACROSS);
    for (int32_t k = 0; k < 3; k++) drop(&hand, 0.3, 0.1, k == 1 ? right : LEFT);
    drop(&hand, 0.3, 0.299, LEFT);   // no load drop
    patterns_add_drops(&patterns, &hand.drops, 1);
    assert_int_equal(patterns.drops, 3);
    assert_true(patterns.count == 2 && patterns.list[0].pads == 1 && patterns.list[1].pads == 2);
    assert_true(patterns.list[0].drops == 2 && patterns.list[1].drops == 1);
    hand_drops_end(&hand);
}
