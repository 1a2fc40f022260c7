// SPDX-License-Identifier: GPL-2.0-or-later
// State of the contact nodes in the step seen last, one array for each quantity. record/history
// writes the arrays, and a caller of amontons.h sees them. Slip is a vector of as many components
// as there are tangents, x first. The arrays stay where they are. This is a Recorder that runs
// before both.
#ifndef AMONTONS_RECORD_CONTACT_ARRAYS_H
#define AMONTONS_RECORD_CONTACT_ARRAYS_H

#include "friction/friction.h"
#include "record/observation.h"

typedef struct ContactArrays {
    const Friction *friction;   // not owned
    int32_t count;   // contact nodes
    bool started;   // the first step was seen
    int32_t tangents;   // 1 in the plane, 2 in space
    double *slip_rate;   // [count * tangents] velocity; owned, like all that follows
    double *slip;   // [count * tangents] since the first step, length
    double *pressure;   // [count] stress
    double *shear;   // [count * tangents] positive where the plane drags the block back, stress
    double *gap;   // [count] over the floor, 0 where they touch, length
    uint8_t *status;   // [count] 0 open, 1 sticks, 2 slips where friction weakens, 3 where it does
        // not
    int32_t states;   // of a node; 0: nothing is remembered
    double *state;   // [count, states] of friction that remembers, as people read it
        // (friction_shown_state); NULL: nothing is remembered
    double *area;   // [count] of the real contacts over that at the start, 0 where open; NULL: no
        // law has a measure of its own (friction_has_area)
    double *origin;   // [count * tangents] displacement in the first step, length
} ContactArrays;

bool contact_arrays_create(const Interface *interface, const Friction *friction,
                           ContactArrays *arrays, Error *err);
void contact_arrays_destroy(ContactArrays *arrays);
bool contact_arrays_record(void *self, const Observation *seen, Error *err);   // a Recorder

// ERROR_COMPUTE: friction of one's own has come to a negative coefficient at a node.
bool seen_check_coefficients(const Observation *seen, const Friction *friction, Error *err);

// Area of the real contacts of node i over that at the start (friction_contact_area); 0: open.
double seen_contact_area(const Observation *seen, const Friction *friction, int32_t i);

// Archives the origin of slip; the arrays follow from the step that is recorded next.
void contact_arrays_archive(ContactArrays *arrays, Archive *archive);

#endif
