// SPDX-License-Identifier: GPL-2.0-or-later
// The longest step of central differences whose viscous forces lag half a step,
//
//     M (v' - v)/dt + C v + K u = f,   u' = u + dt v'.
//
// Its discrete energy  v' (M - dt/2 C - dt^2/4 K) v' / 2 + u_m K u_m / 2,  u_m = (u + u')/2, never
// grows, so it is stable when 4 M - 2 dt C - dt^2 K is positive definite, whether or not C and K
// have modes in common. With bounds l_C and l_K of the eigenvalues of M^-1 C and M^-1 K the limit
// is
//
//     dt < 4 / (l_C + sqrt(l_C^2 + 4 l_K)):   2/l_C where viscosity rules, 2/sqrt(l_K) (about
//                                             h/c) without it.
//
// Called by run/start.
#ifndef AMONTONS_STEPPING_STABLE_STEP_H
#define AMONTONS_STEPPING_STABLE_STEP_H

#include "fem/assembly.h"

// The step is the limit above times a safety factor.
bool stable_step(const Bulk *bulk, double *step, Error *err);

// A bound of the eigenvalues of M^-1 A, A on the bulk's pattern: the largest sum of a row of
// |A_ij|/sqrt(m_i m_j) (Gershgorin; Golub and Van Loan, Matrix Computations, 7.2).
double rate_bound(const Bulk *bulk, const double *values);

#endif
