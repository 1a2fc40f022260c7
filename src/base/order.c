// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/order.h"

#include <stdint.h>

int order_int32(const void *left, const void *right)
{
    int32_t a = *(const int32_t *)left, b = *(const int32_t *)right;
    return (a > b) - (a < b);
}

int order_int32_pairs(const void *left, const void *right)
{
    int first = order_int32(left, right);
    return first ? first : order_int32((const int32_t *)left + 1, (const int32_t *)right + 1);
}

int order_int64(const void *left, const void *right)
{
    int64_t a = *(const int64_t *)left, b = *(const int64_t *)right;
    return (a > b) - (a < b);
}

int order_doubles(const void *left, const void *right)
{
    double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}
