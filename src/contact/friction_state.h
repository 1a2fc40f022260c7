// SPDX-License-Identifier: GPL-2.0-or-later
// Laws with memory, as stepping/ sees them: their states (contact/friction_memory). Each function
// may be asked of a law without memory, which has no state.
#ifndef AMONTONS_CONTACT_FRICTION_STATE_H
#define AMONTONS_CONTACT_FRICTION_STATE_H

#include "contact/friction_law.h"

// The law has a state (contact/friction_memory); of laws that differ along the contact: one has.
bool friction_remembers(const FrictionLaw *law, int32_t count);

// Friction is 0 at rest: no node of this law ever sticks (rate-and-state).
static inline bool friction_creeps(const FrictionLaw *law)
{
    return law->kind == FRICTION_RATE_STATE;
}

// Of a law that creeps (contact/friction_memory): where a step of Newton's method leads in mu.
double friction_follow(const FrictionLaw *law, double velocity, double step);

// The law of a node in a stage: its state obeys state = from + reach g(v, state). Does nothing to a
// law without memory.
void friction_set_stage(FrictionLaw *law, double from, double reach);

// The state of a node at the end of that stage, and mu and g there; without memory 0, and mu alone.
double friction_state(const FrictionLaw *law, double speed);
FrictionRates friction_rates(const FrictionLaw *law, double speed, double state);

// What the state is when the rod begins to move, and a state as people read it.
double friction_start_state(const FrictionLaw *law);
double friction_shown_state(const FrictionLaw *law, double state);

#endif
