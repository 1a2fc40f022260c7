// SPDX-License-Identifier: GPL-2.0-or-later
// The largest eigenvalues of a dense symmetric pencil, a x = mu b x with b positive definite, where
// few of them are wanted: without the others. Called by reduction/reduction.
#ifndef AMONTONS_BASE_LARGEST_EIGEN_H
#define AMONTONS_BASE_LARGEST_EIGEN_H

#include "base/error.h"

#include <stdint.h>

typedef struct LargestEigenDef {
    int32_t size;
    const double *a, *b;   // [size * size], both triangles
    const double *lower;   // b's Cholesky factor L
    double above;   // > 0; eigenvalues above it are wanted
    double least;   // no eigenvalue should be below it; < 0
    double *work;   // [2 * size^2]
} LargestEigenDef;

typedef struct LargestEigen {
    int32_t count;   // of wanted eigenvalues
    double *values;   // [count] ascending; owned
    double *vectors;   // [size * count] L'x, orthonormal; owned
    // A bound of all others, above the largest of them by a hundredth of it or a thousandth of
    // `above` at most.
    double next;
} LargestEigen;

// *found: false, and nothing else, where too many are wanted or multiple, one is below `least`, and
// of sizes below 80. true: what is returned is proven.
bool largest_eigen_find(const LargestEigenDef *def, LargestEigen *largest, bool *found, Error *err);
void largest_eigen_destroy(LargestEigen *largest);

#endif
