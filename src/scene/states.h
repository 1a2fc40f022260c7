// SPDX-License-Identifier: GPL-2.0-or-later
// friction.state: what contacts remember by one's own formulas. Called by scene/scene_read.
#ifndef AMONTONS_SCENE_STATES_H
#define AMONTONS_SCENE_STATES_H

#include "scene/value.h"

// {theta: {rate: "1 - v * theta / D_c", start: 10}}; names that no formula has already.
bool scene_states_set(const SceneKey *key, const SceneValue *value, Scene *scene, Error *err);

#endif
