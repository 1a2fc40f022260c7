// SPDX-License-Identifier: GPL-2.0-or-later
// Checks that no key can make alone: required keys, and keys that must suit each other. Called by
// scene/scene_read.
#ifndef AMONTONS_SCENE_CHECK_H
#define AMONTONS_SCENE_CHECK_H

#include "scene/value.h"

// sources: [key count] where each key was given last; document NULL: nowhere. `file`: the scene
// file's document, for the place of a map that lacks a key.
bool scene_check(const Scene *scene, const SceneValue *sources, const YamlDocument *file,
                 Error *err);

#endif
