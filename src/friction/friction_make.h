// SPDX-License-Identifier: GPL-2.0-or-later
// Makes a law that can be used from what a scene gives. Called by scene/.
#ifndef AMONTONS_FRICTION_FRICTION_MAKE_H
#define AMONTONS_FRICTION_FRICTION_MAKE_H

#include "friction/friction.h"

// Says if a law takes, needs or ignores a key of the map `friction`.
typedef enum FrictionUse { FRICTION_UNUSED, FRICTION_MAY, FRICTION_MUST } FrictionUse;
FrictionUse friction_use(const FrictionLaw *law, const char *key);

// Completes a law of law->kind and of the numbers that the scene gives, 0 where it does not. A
// table, a formula or a plug-in is looked at first (with states: friction/friction_start), and gets
// the numbers mu_S, mu_K and v_c that it has. ERROR_INPUT, with the velocity where the law is not
// one to work with; *key: the key of the map `friction` that is wrong. A law of the pressure is not
// looked at while source->pressure is NaN.
bool friction_make(const FrictionSource *source, FrictionLaw *law, const char **key, Error *err);

#endif
