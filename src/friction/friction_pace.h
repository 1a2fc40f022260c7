// SPDX-License-Identifier: GPL-2.0-or-later
// A law with memory on another clock: at a slip rate `pace` v its states run `pace` times as fast
// as they do at v, and so are the same. A block that is led through its states slower than it is
// driven (study/stability) remembers by it as its own drive would have it. mu is that of v, too,
// but where it falls with slip rate, whatever is remembered: on a slow path it is that of rest.
#ifndef AMONTONS_FRICTION_FRICTION_PACE_H
#define AMONTONS_FRICTION_FRICTION_PACE_H

#include "friction/friction_law.h"

// Laws without memory come back as they are.
FrictionLaw friction_paced(const FrictionLaw *law, double pace);

// A law with memory that holds at rest and at some speed meets less friction the faster it slips,
// with the states as they are.
bool friction_weakens_at_once(const FrictionLaw *law);

#endif
