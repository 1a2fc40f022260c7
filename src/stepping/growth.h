// SPDX-License-Identifier: GPL-2.0-or-later
// How fast does a small disturbance of a quasi-static state grow? Around a state, with the moving
// unknowns u (slipping tangents, open nodes, rod nodes that do not touch, everything inside the
// block; what sticks, is pressed or is pushed does not move), disturbances u exp(lambda t) obey
//
//     P(lambda) u = 0,   P = lambda^2 M + lambda (C - W) + K,   row of a slipping tangent:
//                        P_t + s mu(v) P_n                      (s: direction of slip)
//
// and with branches of the materials P has lambda tau_k/(1 + lambda tau_k) K_k more (fem/spectrum).
// W = diag(-mu'(|v_i|) r_n,i) is the weakening; P_n u is the change of the pressing force at a
// held normal, so mu P_n couples pressure to slip and makes P unsymmetric. Where friction remembers
// W depends on lambda: W + memory/(lambda + fading) (stepping/moving_set). Two questions to it:
//
//   growth_rates  the rightmost lambda, exactly: shift-and-invert Arnoldi on the companion form
//                 with real shifts s (Saad, Numerical Methods for Large Eigenvalue Problems, 2011,
//                 ch. 8). Each product costs one solve with s M + C + K/s, which the border
//                 (reduction/interface_operator) factors once for all states. Re lambda > 0
//                 first: l_sc; lambda real and > 0 first: l_c.
//   growth_scan   real growth without the coupling: the largest weakening_ratio over s
//                 with P_t alone in the rows of slipping tangents.
//
// Called by study/stability/stability.
#ifndef AMONTONS_STEPPING_GROWTH_H
#define AMONTONS_STEPPING_GROWTH_H

#include "stepping/moving_set.h"

enum { GROWTH_KEPT = 8, GROWTH_SHIFTS_MAX = 80 };

typedef struct GrowthDef {
    double slowest, fastest;   // rates looked for: the scan's s go up from one to the other by 2,
        // 1/time. What grows yet faster, far beyond l_c, may be missed.
} GrowthDef;
// Range of rates for a block of this length with so many contact nodes, and c_L: c/(4 L) to some
// c/dx.
GrowthDef growth_def(double length, double speed, int32_t contact_count);

typedef struct GrowthRate {
    double re, im;   // lambda, im >= 0, 1/time
} GrowthRate;

// Arrays belong to the Growth it came from, until its next use.
typedef struct GrowthRates {
    int32_t count;   // at most GROWTH_KEPT
    GrowthRate rate[GROWTH_KEPT];   // of largest re, descending
    GrowthRate real;   // the largest real positive one; 0: none
    const double *mode_re, *mode_im;   // [interface_count] of rate[0]; largest slip 1
    const double *real_mode;   // [interface_count] of `real`; NULL: none
} GrowthRates;

typedef struct GrowthScan {
    double ratio;   // weakening over what the block withstands: >= 1 is real growth
    double rate;   // s where that is, 1/time
} GrowthScan;

typedef struct Growth Growth;

Growth *growth_create(const Block *block, const GrowthDef *def, Error *err);
void growth_destroy(Growth *growth);   // NULL is fine

// Nothing is allocated. ERROR_COMPUTE: the small eigenproblem was not solved.
bool growth_rates(Growth *growth, const State *state, GrowthRates *rates, Error *err);
GrowthScan growth_scan(Growth *growth, const State *state);

#endif
