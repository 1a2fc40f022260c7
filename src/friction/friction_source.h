// SPDX-License-Identifier: GPL-2.0-or-later
// How one's own friction law comes from the keys of a scene. Filled by scene/own_law.
#ifndef AMONTONS_FRICTION_FRICTION_SOURCE_H
#define AMONTONS_FRICTION_FRICTION_SOURCE_H

#include "base/formula.h"

enum { STATE_NAME_SIZE = 32, STATE_TEXT_SIZE = 512 };

// A state of one's own, an entry of friction.state.
typedef struct FrictionStateText {
    char name[STATE_NAME_SIZE];
    char rate[STATE_TEXT_SIZE];   // formula of v, p and all states
    char start[STATE_TEXT_SIZE];   // formula of numbers; empty: that of steady slip
} FrictionStateText;

// The parts of a law of one's own, as a scene gives them in its map `friction`. Nothing is owned.
typedef struct FrictionSource {
    const double *velocity, *mu;   // [velocity_count], [mu_count]
    int32_t velocity_count, mu_count;
    bool straight;
    const char *formula, *file;
    FormulaLookUp look_up;   // numbers that a formula may name; NULL: none
    const void *context;   // for it
    const FrictionStateText *state;   // [state_count]
    int32_t state_count;
    double rod_velocity, rest, pressure, slip_distance;   // friction.rest; nominal; 0: not given
    const double *parameters;   // [parameter_count] of a plug-in
    int32_t parameter_count;
    double end;   // of a formula or plug-in, velocity
    bool trusted;   // a plug-in may be run
} FrictionSource;

// Whether a law takes, needs or ignores one of the keys of that map.
typedef enum FrictionUse { FRICTION_UNUSED, FRICTION_MAY, FRICTION_MUST } FrictionUse;

#endif
