// SPDX-License-Identifier: GPL-2.0-or-later
// The items of friction.contacts: read by scene/scene_read, made into laws by model/node_laws.
#ifndef AMONTONS_SCENE_CONTACT_LAWS_H
#define AMONTONS_SCENE_CONTACT_LAWS_H

#include "scene/value.h"

// Fills scene->contact_laws from the list `value`, when scene->friction is complete. ERROR_INPUT
// shows the place.
bool scene_contact_laws(const SceneValue *value, Scene *scene, Error *err);

// The item has a law of its own; else it is that of the scene.
bool scene_has_contact_law(const SceneContactLaw *item);

// The law of an item: the scene's, with what the item says otherwise. pressure: nominal, stress.
bool scene_contact_law(const Scene *scene, const SceneContactLaw *item, double pressure,
                       FrictionLaw *law, Error *err);

#endif
