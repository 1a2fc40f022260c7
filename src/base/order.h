// SPDX-License-Identifier: GPL-2.0-or-later
// Ascending orders for qsort and bsearch. A struct is ordered by its first member.
#ifndef AMONTONS_BASE_ORDER_H
#define AMONTONS_BASE_ORDER_H

int order_int32(const void *left, const void *right);
int order_int32_pairs(const void *left, const void *right);   // by the first two members
int order_int64(const void *left, const void *right);
int order_doubles(const void *left, const void *right);   // no NaN among them

#endif
