// SPDX-License-Identifier: GPL-2.0-or-later
// The friction law from the keys of a scene. Called by scene/scene_read and scene/contact_laws.
#ifndef AMONTONS_SCENE_FRICTION_LAW_H
#define AMONTONS_SCENE_FRICTION_LAW_H

#include "scene/scene.h"

// Completes a law that has its kind, mu_S, mu_K and v_c: the scene's, or that of an item of
// contacts with its own formula. *key: of the map `friction`, which is wrong (ERROR_INPUT, with the
// velocity where the law is not one to work with). pressure: nominal, stress; NaN: not known yet,
// and a law that depends on it is not complete.
bool scene_friction_law(const Scene *scene, const char *formula, double pressure, FrictionLaw *law,
                        const char **key, Error *err);

// Pressure of the load, stress; NaN: load.force is given, and the mesh says over which area.
double scene_nominal_pressure(const Scene *scene);

// The scene's law depends on a pressure that is not known yet: scene->friction is not complete.
bool scene_law_waits(const Scene *scene);

// The scene's law, completed with the nominal pressure where it waits for it.
bool scene_law_at(const Scene *scene, double pressure, FrictionLaw *law, const char **key,
                  Error *err);

// Number of the quantity of the map `friction` that a formula calls by this name or symbol; -1:
// none.
int32_t scene_friction_number(const char *name);

#endif
