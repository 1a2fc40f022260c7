// SPDX-License-Identifier: GPL-2.0-or-later
// A factor by points: between them, at jumps, beyond the end, over and over.
#include "base/schedule.h"

#include "near.h"

static const Schedule TABLE = {.count = 5, .at = {0, 2, 3, 3, 5}, .factor = {1, 1, -2, 4, 0.5}};

TEST(test_once)
{
    const double wanted[][3] = {// x, factor, next point
                                {0, 1, 2},          {1, 1, 2},          {2, 1, 3},
                                {2.5, -0.5, 3},     {3, -2, 5},         {3.5, 3.125, 5},
                                {5, 0.5, INFINITY}, {77, 0.5, INFINITY}};
    for (size_t k = 0; k < sizeof wanted / sizeof *wanted; k++) {
        assert_near("factor", schedule_factor(&TABLE, wanted[k][0]), wanted[k][1], 1e-9);
        assert_true(schedule_next(&TABLE, wanted[k][0]) == wanted[k][2]);
    }
    assert_near("largest", schedule_largest(&TABLE), 4, 0);
    const Schedule none = {0};
    assert_true(schedule_factor(&none, 3) == 1 && schedule_largest(&none) == 1);
    assert_true(schedule_next(&none, 3) == INFINITY);
}

// A step that ends at a point up to rounding has ended there.
TEST(test_rounding)
{
    for (int32_t side = -1; side < 2; side += 2) {
        double x = 3 * (1 + side * 4e-16);
        assert_near("before the jump", schedule_factor(&TABLE, x), -2, 1e-9);
        assert_true(schedule_next(&TABLE, x) == 5);
    }
    assert_near("after it", schedule_factor(&TABLE, 3 * (1 + 1e-9)), 4, 1e-6);
}

TEST(test_repeated)
{
    Schedule table = TABLE;
    table.repeats = true;
    for (double x = 0.1; x < 5; x += 0.237) {
        for (int32_t rounds = 1; rounds < 40; rounds += 13) {
            assert_near("again", schedule_factor(&table, x + 5 * rounds),
                        schedule_factor(&TABLE, x), 1e-9);
            double next = schedule_next(&TABLE, x);
            assert_near("next", schedule_next(&table, x + 5 * rounds), next + 5 * rounds, 1e-9);
        }
    }
    assert_near("the end of a round", schedule_factor(&table, 10), 0.5, 1e-9);
    assert_near("and the next one's first point", schedule_next(&table, 10), 12, 1e-9);
}
