// SPDX-License-Identifier: GPL-2.0-or-later
// One's own law that remembers, from what a scene gives to one that can be used: its states when
// the rod begins to move, a look at it, its scales. Called by friction/friction_make,
// and for steady slip by run/warnings and study/stability.
#ifndef AMONTONS_FRICTION_FRICTION_START_H
#define AMONTONS_FRICTION_FRICTION_START_H

#include "friction/friction.h"

// Kind, states and functions of the law are set. Completes it:
//
//   start    given by the scene or the plug-in; else that of steady slip at the rod's velocity;
//            then the contacts rest for source->rest, d state/dt = g(0, state)
//   creeps   mu(0) is 0 at the start and in steady slip, and rises with v
//   mu_S     mu(0) at the start; of a law that creeps the most of steady slip
//   mu_K     the least mu of steady slip
//   v_c      the speed at which steady slip has lost 1 - 1/e of that drop
//   D_c      drop over the most that mu loses in a unit of slip by its states
//
// A mu_S, mu_K, v_c or D_c that the scene gives stays. ERROR_INPUT, with the velocity and the
// states: not finite, negative, not continuous in one of its arguments; or no steady state is
// found. *key: of the map `friction`.
bool friction_start(const FrictionSource *source, FrictionLaw *law, const char **key, Error *err);

// True if a law whose mu rises from `rests` at rest never holds: that is nothing beside
// `reference`, mu at the rod's velocity.
static inline bool friction_never_holds(double rests, double rises, double reference)
{
    static const double NO_FRICTION = 1e-12;
    return rests <= NO_FRICTION * reference && rises > 0;
}

// node->from becomes the states of steady slip. Returns false where none is found from there, and
// leaves it as it was.
bool friction_find_steady(FrictionNode *node, double speed);

// mu, g and their derivatives at steady slip at this speed under node->pressure, and its states
// [states]. Where no steady slip is found: in the states with which the rod begins to move.
FrictionRates friction_steady_rates(const FrictionNode *node, double speed, double *state);

// The slowest rate at which steady slip at this speed forgets what the contact remembers, 1/time;
// INFINITY: nothing is remembered.
double friction_forgets(const FrictionNode *node, double speed);

#endif
