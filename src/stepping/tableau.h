// SPDX-License-Identifier: GPL-2.0-or-later
// Butcher tableau of SDIRK2, singly diagonal (one matrix for both stages), stiffly accurate (the
// last row is b: contact, friction and rod hold at the end of a step) and L-stable (Alexander, SIAM
// J. Numer. Anal. 14, 1977):
//
//     gamma | gamma                   gamma = 1 - 1/sqrt 2
//     1     | 1 - gamma  gamma
//     ------+-----------------
//           | 1 - gamma  gamma
//
// The estimate of the local error is calibrated on v' = lambda v, z = lambda dt, to which every
// smooth linear motion comes down, loads and the rod's way included: R(z) = 1 + z b (I - z A)^-1 1
// misses exp(z) by C z^3 (Hairer and Wanner, Solving ODEs II, IV.3), C = -0.0404, and the estimate
// has the same C and no lower powers of z. It is made of v_n and the stages:
// quadrature through them alone is too small, as the first stage is of order 1. Used by
// stepping/sdirk.
#ifndef AMONTONS_STEPPING_TABLEAU_H
#define AMONTONS_STEPPING_TABLEAU_H

enum { SDIRK_STAGES = 2 };
static const double LOCAL_ORDER = 3;   // order of the local error, one above the scheme's

typedef struct Tableau {
    double gamma;
    double a[SDIRK_STAGES][SDIRK_STAGES];   // lower triangle; the last row is b
    double c[SDIRK_STAGES];
    // dt (error[0] v_n + error[1] v_1 + error[2] v_2) is the local error of u, exact step less
    // ours, to leading order dt^3 where motion is smooth and friction falls linearly.
    double error[SDIRK_STAGES + 1];
} Tableau;

static const Tableau SDIRK2 = {
    .gamma = 1 - 0.70710678118654752440,
    .a = {{1 - 0.70710678118654752440}, {0.70710678118654752440, 1 - 0.70710678118654752440}},
    .c = {1 - 0.70710678118654752440, 1},
    // -sqrt 2/3, 2/3, -(2 - sqrt 2)/3
    .error = {-0.47140452079103168293, 2. / 3, -0.19526214587563498373}};

#endif
