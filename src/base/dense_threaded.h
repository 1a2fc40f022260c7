// SPDX-License-Identifier: GPL-2.0-or-later
// Products of dense matrices of which two threads do half of the columns each, where they are large
// enough for that. Not from within a half of base/share. Called by reduction/responses
// and those of reduction/basis_*.
#ifndef AMONTONS_BASE_DENSE_THREADED_H
#define AMONTONS_BASE_DENSE_THREADED_H

#include "base/dense.h"

// As dense_multiply_transposed and dense_multiply.
void dense_multiply_transposed_threaded(DenseView a, DenseView b, double factor, double keep,
                                        double *c);
void dense_multiply_threaded(DenseView a, DenseView b, double factor, double keep, double *c);

#endif
