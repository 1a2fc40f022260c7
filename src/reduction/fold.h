// SPDX-License-Identifier: GPL-2.0-or-later
// One of the two halves of a vector that has a mirror image: what is alike on both sides, or what
// is opposite. A pair of unknowns x, x* of the whole is (x + s x*)/sqrt(2) in a half, with s = 1
// or -1; an unknown that is its own image is as it is, in one of them: it stands as a pair with
// itself and s = 0. Both halves together are an orthogonal turn T of the whole. Used where there
// are halves (reduction/mirror).
#ifndef AMONTONS_REDUCTION_FOLD_H
#define AMONTONS_REDUCTION_FOLD_H

#include "base/error.h"

#include <stdint.h>

typedef struct Fold {
    int32_t count;   // of the half
    int32_t *one, *other;   // [count] unknowns of the whole; owned
    double *sign;   // [count] s; owned
    double *weight;   // [count] 1/sqrt(2) of a pair, else 1; owned
} Fold;

// Room for at most `count`; Fold.count starts at 0.
bool fold_create(int32_t count, Fold *fold, Error *err);
void fold_destroy(Fold *fold);
void fold_append(Fold *fold, int32_t one, int32_t other, double sign);

void fold_take(const Fold *fold, const double *whole, double *half);   // half = T whole
void fold_add(const Fold *fold, const double *half, double *whole);   // whole += T' half
// whole [size^2] += T' half T, half [count^2] symmetric.
void fold_add_square(const Fold *fold, const double *half, int32_t size, double *whole);

#endif
