// SPDX-License-Identifier: GPL-2.0-or-later
// Friction laws from the keys of a scene: its own, and those of the items of friction.contacts.
// Called by scene/scene_read and model/contact_nodes.
#ifndef AMONTONS_SCENE_FRICTION_LAW_H
#define AMONTONS_SCENE_FRICTION_LAW_H

#include "scene/value.h"

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

// Fills scene->contact_laws from the list `value`, when scene->friction is complete. ERROR_INPUT
// shows the place.
bool scene_contact_laws(const SceneValue *value, Scene *scene, Error *err);

// The item has a law of its own; else it is that of the scene.
bool scene_has_contact_law(const SceneContactLaw *item);

// The law of an item: the scene's, with what the item says otherwise. pressure: nominal, stress.
bool scene_contact_law(const Scene *scene, const SceneContactLaw *item, double pressure,
                       FrictionLaw *law, Error *err);

#endif
