// SPDX-License-Identifier: GPL-2.0-or-later
// Laws with memory, as stepping/ sees them: their states (friction/friction_memory). Each function
// may be asked of a law without memory, which has no state.
#ifndef AMONTONS_FRICTION_FRICTION_STATE_H
#define AMONTONS_FRICTION_FRICTION_STATE_H

#include "friction/friction_law.h"

// The law has states (friction/friction_memory); of laws that differ along the contact: one has.
bool friction_remembers(const FrictionLaw *law, int32_t count);

// How many a node has; of laws that differ: the most.
int32_t friction_states(const FrictionLaw *law, int32_t count);

// Friction is 0 at rest: no node of this law ever sticks (rate-and-state).
static inline bool friction_creeps(const FrictionLaw *law)
{
    return law->remembers && law->own.memory.creeps;
}

// mu or a rate asks for pressure.
static inline bool friction_feels_pressure(const FrictionLaw *law)
{
    return law->remembers && law->own.memory.feels_pressure;
}

// For a law that creeps (friction/friction_memory): where a step of Newton's method [count] leads
// in friction.
void friction_follow(const FrictionLaw *law, int32_t count, const double *velocity,
                     const double *step, double *next);

// The law of a node in a stage: its states obey state = from + reach g(v, state). Does nothing to a
// law without memory.
void friction_set_stage(FrictionLaw *law, const double *from, double reach);

// Its pressure in that stage, of a law that asks for it; returns by how much mu at this speed
// changes with that, 1.
double friction_set_pressure(FrictionLaw *law, double pressure, double speed);

// The states of a node at the end of that stage [friction_states], none without memory.
void friction_state(const FrictionLaw *law, double speed, double *state);
// mu and g there, without memory mu alone.
void friction_rates(const FrictionLaw *law, double speed, const double *state,
                    FrictionRates *rates);
// The same at a pressure that need not be that of the stage.
void friction_rates_pressed(const FrictionLaw *law, double pressure, double speed,
                            const double *state, FrictionRates *rates);

// mu_v alone, at the end of that stage.
double friction_direct_slope(const FrictionLaw *law, double speed);

// The states when the rod begins to move; and the value of state k as it is printed.
void friction_start_state(const FrictionLaw *law, double *state);
double friction_shown_state(const FrictionLaw *law, int32_t k, double state);

#endif
