// SPDX-License-Identifier: GPL-2.0-or-later
// friction.state: what contacts remember by one's own formulas. Called by scene/items.
#ifndef AMONTONS_SCENE_STATES_H
#define AMONTONS_SCENE_STATES_H

#include <stdbool.h>

// Letters, digits and _, of which no formula has another meaning.
bool scene_state_may_be(const char *name);

#endif
