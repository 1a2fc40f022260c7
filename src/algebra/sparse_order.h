// SPDX-License-Identifier: GPL-2.0-or-later
// A fill-reducing order by nested dissection of what is known to lie in space. Used by
// algebra/sparse_factor.
#ifndef AMONTONS_ALGEBRA_SPARSE_ORDER_H
#define AMONTONS_ALGEBRA_SPARSE_ORDER_H

#include "algebra/sparse.h"

// order [size]: the unknowns of the interior in the order of their elimination, then the border as
// given. place: [3 * size] coordinates of each unknown.
bool sparse_order_dissect(const SparsePattern *pattern, const double *place, const int32_t *border,
                          int32_t border_count, int32_t *order, Error *err);

#endif
