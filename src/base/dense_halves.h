// SPDX-License-Identifier: GPL-2.0-or-later
// Products of dense matrices of which two threads do half of the columns each, where they are large
// enough for that. Not from within a half of base/share. Called by reduction/answers
// and those of reduction/basis_*.
#ifndef AMONTONS_BASE_DENSE_HALVES_H
#define AMONTONS_BASE_DENSE_HALVES_H

#include "base/dense.h"

// As dense_multiply_transposed and dense_multiply.
void dense_multiply_transposed_halves(DenseView a, DenseView b, double factor, double keep,
                                      double *c);
void dense_multiply_halves(DenseView a, DenseView b, double factor, double keep, double *c);

#endif
