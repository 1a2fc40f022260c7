// SPDX-License-Identifier: GPL-2.0-or-later
// A law with memory on another clock: its states, and what creeps, run `pace` times as fast, so
// that they are at a slip rate `pace` v what the law itself makes of v. A block that is led through
// its states slower than it is driven (study/stability) remembers by it as its own drive would have
// it. Weakening with slip rate alone stays as it is: on a slow path it is that of rest.
#ifndef AMONTONS_FRICTION_FRICTION_PACE_H
#define AMONTONS_FRICTION_FRICTION_PACE_H

#include "friction/friction_law.h"

// The laws that are built in; others come back as they are.
FrictionLaw friction_paced(const FrictionLaw *law, double pace);

// What a state is called there.
double friction_paced_state(const FrictionLaw *law, double state, double pace);

#endif
