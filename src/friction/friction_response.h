// SPDX-License-Identifier: GPL-2.0-or-later
// The response of friction that remembers to a small disturbance of slip, from mu, g and their
// derivatives at a node (friction/friction.h). With any number of states
//
//     mu' = mu_v v' + mu_theta theta',     d theta'/dt = g_v v' + g_theta theta',
//
// and on exp(s t) mu' = F(s) v', F(s) = mu_v + mu_theta (s - g_theta)^-1 g_v. Called by stepping/
// and study/stability.
#ifndef AMONTONS_FRICTION_FRICTION_RESPONSE_H
#define AMONTONS_FRICTION_FRICTION_RESPONSE_H

#include "friction/friction.h"

// A small disturbance exp(s t) of slip feels -mu_theta (s - g_theta)^-1 g_v, by which what is
// remembered weakens: at the real s = 1/reach, and the most that its real part is at any s with
// |s| >= 1/reach and Re s >= 0, or more than that; INFINITY: no bound is known. Both one over a
// velocity.
double friction_weakens_at(const FrictionRates *rates, double reach);
double friction_weakens_most(const FrictionRates *rates, double reach);

// theta' of (s - g_theta) theta' = g_v s y - c, of slip at the rate s y, s > 0. c and z, which gets
// theta' (NULL is fine), [states], are each over a scale of its own, which makes them ways of slip.
// Returns by how much mu falls with it, times what mu_state is given in.
double friction_respond(const FrictionRates *rates, double s, double y, const double *c, double *z);

// The states by themselves, at held slip: d theta'/dt = g_theta theta'. The rates of that [states],
// 1/time; INFINITY where they are not found.
void friction_own_rates(const FrictionRates *rates, double *re, double *im);
// True if none of these rates is real and 1/reach or more: no state grows as fast as that.
bool friction_states_decay(const FrictionRates *rates, double reach);

// A massless body on a spring k, pressed by r_n, has the rates s with k + s r_n F(s) = 0: k over
// r_n, one over a length, above which all of them decay; 0: on any spring. NAN: on none.
double friction_critical_stiffness(const FrictionRates *rates);

#endif
