// SPDX-License-Identifier: GPL-2.0-or-later
// Lengths of vectors are sqrt(x' W x): where A is symmetric so is A^-1 W in that product, and the
// growth of the length converges twice as fast as the vector (Parlett, The Symmetric Eigenvalue
// Problem, 4.2).
#include "stepping/weakening_ratio.h"

#include "base/dense.h"

#include <math.h>

// Where powers begin at least this part is along the vector that they tend to: it weakens most, and
// they begin with all that weakens.
static const double START_PART = 1e-6;

static double length_of(const MovingSet *set, const double *x)
{
    double square = 0;
    for (int32_t a = 0; a < set->count; a++) square += set->list[a].weakening * x[a] * x[a];
    return sqrt(square);
}

// Where ratios of several nodes lie close together, as on short steps, where mass decides, powers
// do not settle: then the growth over all n of them bounds the ratio, as ratio^n START_PART is at
// most |x_n|/|x_0|. For n = 200 the bound is up to START_PART^(-1/n), 7 %, too large.
double weakening_ratio(const MovingSet *set, const double *lu, const int32_t *pivots,
                       int32_t powers_max, double tolerance, double *x)
{
    if (!set->weakens) return 0;
    double ratio = INFINITY, logarithm = 0;   // of |x_n|/|x_0|
    for (int32_t a = 0; a < set->count; a++) x[a] = 1;
    double length = length_of(set, x);
    for (int32_t power = 0; power < powers_max; power++) {
        double before = ratio;
        for (int32_t a = 0; a < set->count; a++) x[a] *= set->list[a].weakening / length;
        dense_lu_solve(lu, set->count, pivots, x);
        ratio = length = length_of(set, x);
        if (fabs(ratio - before) <= tolerance * ratio) return ratio;
        logarithm += log(ratio);
    }
    return fmax(ratio, exp((logarithm - log(START_PART)) / powers_max));
}

double weakening_ratio_top(const double ratio[3], double *octaves)
{
    double slope = (ratio[2] - ratio[0]) / 2, curve = ratio[2] - 2 * ratio[1] + ratio[0];
    *octaves = 0;
    if (!(curve < 0 && ratio[1] >= ratio[0] && ratio[1] >= ratio[2])) return ratio[1];
    *octaves = -slope / curve;
    return ratio[1] - slope * slope / (2 * curve);
}
