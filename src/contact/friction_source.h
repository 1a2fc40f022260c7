// SPDX-License-Identifier: GPL-2.0-or-later
// How one's own friction law comes from the keys of a scene. Filled by scene/own_law.
#ifndef AMONTONS_CONTACT_FRICTION_SOURCE_H
#define AMONTONS_CONTACT_FRICTION_SOURCE_H

#include <stdbool.h>
#include <stdint.h>

// What one's own law is made of, as a scene gives it in its map `friction`. Nothing is owned.
typedef struct FrictionSource {
    const double *velocity, *mu;   // [velocity_count], [mu_count]
    int32_t velocity_count, mu_count;
    bool straight;
    const char *formula, *file;
    const double *parameters;   // [parameter_count] of a plug-in
    int32_t parameter_count;
    double end;   // of a formula or plug-in, velocity
} FrictionSource;

// What one of the keys of that map is to a law.
typedef enum FrictionUse { FRICTION_UNUSED, FRICTION_MAY, FRICTION_MUST } FrictionUse;

#endif
