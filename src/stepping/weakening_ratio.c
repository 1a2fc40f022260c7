// SPDX-License-Identifier: GPL-2.0-or-later
// Lengths of vectors are sqrt(x' W x): where A is symmetric so is A^-1 W in that product, and the
// growth of the length converges twice as fast as the vector (Parlett, The Symmetric Eigenvalue
// Problem, 4.2).
#include "stepping/weakening_ratio.h"

#include "algebra/dense.h"

#include <math.h>

enum { POWERS_LIMIT = 1000 };   // 300 were enough for 430 000 ratios of 60 scenes

static double length_of(const MovingSet *set, const double *x)
{
    double square = 0;
    for (int32_t a = 0; a < set->count; a++) square += set->list[a].weakening * x[a] * x[a];
    return sqrt(square);
}

double weakening_ratio(const MovingSet *set, const double *lu, const int32_t *pivots,
                       double tolerance, double *x)
{
    if (!set->weakens) return 0;
    for (int32_t a = 0; a < set->count; a++) x[a] = 1;
    double length = length_of(set, x), ratio = INFINITY;
    for (int32_t power = 0; power < POWERS_LIMIT; power++) {
        double before = ratio;
        for (int32_t a = 0; a < set->count; a++) x[a] *= set->list[a].weakening / length;
        dense_lu_solve(lu, set->count, pivots, x);
        ratio = length = length_of(set, x);
        if (fabs(ratio - before) <= tolerance * ratio) return ratio;
    }
    return INFINITY;
}

double weakening_ratio_top(const double ratio[3], double *octaves)
{
    double slope = (ratio[2] - ratio[0]) / 2, curve = ratio[2] - 2 * ratio[1] + ratio[0];
    *octaves = 0;
    if (!(curve < 0 && ratio[1] >= ratio[0] && ratio[1] >= ratio[2])) return ratio[1];
    *octaves = -slope / curve;
    return ratio[1] - slope * slope / (2 * curve);
}
