// SPDX-License-Identifier: GPL-2.0-or-later
// One's own friction law from the keys of a scene. Called by scene/scene_read.
#ifndef AMONTONS_SCENE_OWN_LAW_H
#define AMONTONS_SCENE_OWN_LAW_H

#include "scene/scene.h"

// Completes scene->friction where it is a table, a formula or a plug-in, or has memory; else does
// nothing.
// *key: of the map `friction`, which is wrong (ERROR_INPUT, with the velocity where the law is not
// one to work with).
bool scene_own_law(Scene *scene, const char **key, Error *err);

// Completes a law with memory, which has its kind and its numbers; does nothing to others. *key as
// above.
bool scene_remember(const Scene *scene, FrictionLaw *law, const char **key, Error *err);

// Whose numbers a formula may name.
typedef struct SceneNumbersOf {
    const Scene *scene;
    const FrictionLaw *law;   // its numbers: of the scene, or of an item of contacts
} SceneNumbersOf;

// Which of the numbers of the map `friction` a formula calls by this name or symbol; -1: none.
int32_t scene_friction_number(const char *name);

// Friction source from the scene's keys for a law of one's own; `of` must outlive it.
FrictionSource scene_friction_source(const SceneNumbersOf *of);

// The slip rate up to which a formula or plug-in is asked: friction.velocity_max, or that of sound.
double scene_fastest_slip(const Scene *scene);

#endif
