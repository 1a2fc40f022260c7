// SPDX-License-Identifier: GPL-2.0-or-later
// The questions of stepping/certificate to a state that is looked at as a whole, or where it is its
// own mirror image to what is even and what is odd of it (stepping/half_step), whichever the ladder
// is asked for. What is odd is asked no further where it cannot gain energy. Called by
// stepping/step_control.
#ifndef AMONTONS_STEPPING_BOTH_SIDES_H
#define AMONTONS_STEPPING_BOTH_SIDES_H

#include "stepping/half_step.h"

// Nothing is owned.
typedef struct BothSides {
    Certificate *whole;
    HalfStep *half;
    Ladder *ladder;
} BothSides;

// certificate_holds. *odd_decays: of what is odd alone; false, too, where there are no halves. The
// questions that follow are about the state that this was asked about last.
bool both_sides_hold(BothSides sides, const State *state, double reach, bool *odd_decays);

// Questions to the certificate about the rungs of a range; the first two are about its first rung
// alone.
typedef enum BothSidesAsked {
    SIDES_RESOLVE,   // certificate_step_resolves
    SIDES_FIND_NO_RUNAWAY,   // not certificate_finds_runaway, known to hold on that rung
    SIDES_OSCILLATE_LESS,   // certificate_oscillates_less than `growth`
    SIDES_EXCLUDE_RUNAWAY   // certificate_excludes_runaway
} BothSidesAsked;

bool both_sides_ask(BothSides sides, const State *state, BothSidesAsked asked, RungRange range,
                    double growth);

#endif
