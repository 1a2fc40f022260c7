// SPDX-License-Identifier: GPL-2.0-or-later
// Extremes, where a difference would overflow; structs by their first member.
#include "base/order.h"

#include "near.h"

TEST(test_extremes)
{
    int32_t whole[] = {INT32_MAX, 0, INT32_MIN, -1};
    int64_t wide[] = {INT64_MAX, 0, INT64_MIN, -1};
    double real[] = {INFINITY, 0.5, -INFINITY, -1e308};
    qsort(whole, 4, sizeof *whole, order_int32);
    qsort(wide, 4, sizeof *wide, order_int64);
    qsort(real, 4, sizeof *real, order_doubles);
    for (int32_t k = 0; k < 3; k++) {
        assert_true(whole[k] < whole[k + 1]);
        assert_true(wide[k] < wide[k + 1]);
        assert_true(real[k] < real[k + 1]);
    }
    assert_int_equal(order_doubles(&(double){0.0}, &(double){-0.0}), 0);
}

TEST(test_first_member)
{
    struct {
        int64_t key, value;
    } pairs[] = {{3, 30}, {1, 10}, {2, 20}};
    qsort(pairs, 3, sizeof *pairs, order_int64);
    for (int32_t k = 0; k < 3; k++) assert_int_equal(pairs[k].value, 10 * (k + 1));
}

TEST(test_pairs)
{
    int32_t sides[][3] = {{2, 1, 3}, {1, INT32_MAX, 2}, {INT32_MIN, 7, 0}, {1, INT32_MIN, 1}};
    qsort(sides, 4, sizeof *sides, order_int32_pairs);
    for (int32_t k = 0; k < 4; k++) assert_int_equal(sides[k][2], k);
    assert_int_equal(order_int32_pairs((int32_t[]){4, 5, 6}, (int32_t[]){4, 5, 9}), 0);
}
