// SPDX-License-Identifier: GPL-2.0-or-later
// The rod that drives the block: node j of the strip is held at, or pushed to,
// u_x = u_x,j(0) + V t, with no shear. Used by contact/contact_problem and stepping/sdirk2.
#ifndef AMONTONS_CONTACT_ROD_H
#define AMONTONS_CONTACT_ROD_H

#include "contact/interface.h"

typedef enum RodKind {
    ROD_AWAY,   // touches nothing (while the block relaxes)
    ROD_PUSHES,   // unilateral: can lose contact, never pulls
    ROD_IS_BONDED   // bilateral
} RodKind;

typedef struct Rod {
    RodKind kind;
    double velocity;   // V, velocity
    double *origin;   // [rod_count] u_x,j(0), length; owned
    int32_t count;
} Rod;

bool rod_build(const Interface *interface, RodKind kind, double velocity, Rod *rod, Error *err);
void rod_destroy(Rod *rod);

// F_T, from the reactions on the interface [interface->count].
double rod_force(const Interface *interface, const double *reaction);

#endif
