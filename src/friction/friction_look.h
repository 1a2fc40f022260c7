// SPDX-License-Identifier: GPL-2.0-or-later
// Looks at one's own law of speed alone before it is used: is it one that the rest can work with,
// and what are its scales? Called by friction/friction_make.
#ifndef AMONTONS_FRICTION_FRICTION_LOOK_H
#define AMONTONS_FRICTION_FRICTION_LOOK_H

#include "friction/friction.h"

// law: kind, end and functions are set; mu_static, mu_kinetic and critical_velocity as the scene
// gives them, 0 where it does not. Sets these three, and what else of its shape is kept:
//
//   mu_S   mu(0)
//   mu_K   the lowest coefficient
//   v_c    the speed at which the weakening -mu' (of a law that only rises: mu') has changed by
//          1 - 1/e of its largest value from what it is at rest: so it is v_c of the linear and of
//          the exponential law
//
// A v_c that is given stays, a mu_K too, which must be a lower bound. ERROR_INPUT, with the
// velocity: not finite, negative, not continuous, or a slope that is not that of mu; or a mu_static
// or mu_kinetic that is not that of the law.
bool friction_look(FrictionLaw *law, Error *err);

#endif
