// SPDX-License-Identifier: GPL-2.0-or-later
// The friction law from the keys of a scene. Called by scene/scene_read and scene/contact_laws.
#ifndef AMONTONS_SCENE_FRICTION_LAW_H
#define AMONTONS_SCENE_FRICTION_LAW_H

#include "scene/scene.h"

// Completes a law that has its kind, mu_S, mu_K and v_c: the scene's, or that of an item of
// contacts with its own formula. *key: of the map `friction`, which is wrong (ERROR_INPUT, with the
// velocity where the law is not one to work with).
bool scene_friction_law(const Scene *scene, const char *formula, FrictionLaw *law, const char **key,
                        Error *err);

// Number of the quantity of the map `friction` that a formula calls by this name or symbol; -1:
// none.
int32_t scene_friction_number(const char *name);

#endif
