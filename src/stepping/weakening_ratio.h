// SPDX-License-Identifier: GPL-2.0-or-later
// Weakening over what a state withstands of it. With A(s) the matrix of stepping/moving_set made of
// S(s) = s M + C + K/s condensed on the interface,
//
//     ratio(s) = largest eigenvalue of A(s)^-1 W:     1: s is a real rate of growth,
//                                                    below 1 for all s > 0: there is none.
//
// Two real rates are born as one, where ratio(s) has a maximum, in general between two s at which
// it was computed. Called by stepping/certificate and stepping/growth.
#ifndef AMONTONS_STEPPING_WEAKENING_RATIO_H
#define AMONTONS_STEPPING_WEAKENING_RATIO_H

#include "stepping/moving_set.h"

// ratio(s) by powers of A^-1 W until two of them agree to `tolerance`, relative; INFINITY where
// they never do. lu, pivots: A as dense_lu leaves it. x: [count] work. 0 where nothing weakens.
double weakening_ratio(const MovingSet *set, const double *lu, const int32_t *pivots,
                       double tolerance, double *x);

// The top of the parabola through ratios at three s, each twice the one before, in log s; the
// middle one where that is not the largest. *octaves: how far from the middle s the top is.
double weakening_ratio_top(const double ratio[3], double *octaves);

#endif
