// SPDX-License-Identifier: GPL-2.0-or-later
// Makes laws that need more than three numbers, from what a scene gives. Called by scene/.
#ifndef AMONTONS_FRICTION_FRICTION_MAKE_H
#define AMONTONS_FRICTION_FRICTION_MAKE_H

#include "friction/friction_law.h"
#include "friction/friction_source.h"

// Whether a law takes, needs or ignores a key of the map `friction`.
FrictionUse friction_use(const FrictionLaw *law, const char *key);

// Makes one's own law of kind law->kind and of the numbers mu_static, mu_kinetic and
// critical_velocity, 0 where they are not given; friction/friction_look has still to look at it.
// *key: the one that is wrong (ERROR_INPUT), or that holds the law.
bool friction_own_law(const FrictionSource *source, FrictionLaw *law, const char **key, Error *err);

// A law with memory of kind law->kind and of what `memory` says; what else the law holds follows.
void friction_make_memory(const FrictionMemory *memory, FrictionLaw *law);

#endif
