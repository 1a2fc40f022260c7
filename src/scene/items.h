// SPDX-License-Identifier: GPL-2.0-or-later
// Values that are lists or maps of maps, as SceneItems says: load.tractions, load.supports,
// friction.contacts, friction.state, materials. Called by scene/scene_read, and by scene/json to
// write them.
#ifndef AMONTONS_SCENE_ITEMS_H
#define AMONTONS_SCENE_ITEMS_H

#include "scene/value.h"

// Fills the items from `value`; or, where value->part is the rest of the path of a --set ("pads",
// "pads.young"), the one item or word that it names. ERROR_INPUT shows the place.
bool scene_items_set(const SceneKey *key, const SceneValue *value, Scene *scene, Error *err);

// Number of items, and item number k, which begins with its name.
int32_t scene_items_count(const SceneItems *items, const Scene *scene);
const char *scene_item(const SceneItems *items, const Scene *scene, int32_t k);

// The key of a part of item number k, called `name`: its place is in Scene.
SceneKey scene_part_key(const SceneItems *items, const ScenePart *part, int32_t k,
                        const char *name);
// Returns false for words that take texts, in which `=` means nothing.
bool scene_part_has_numbers(const SceneItems *items, const char *word);
// Dimension of the number that a path names as after --set ("load.pressure", "mesh.set.length",
// "materials.pads.young", "material.relaxation.0.time"); NULL: it names none. *total: the other one
// that it may have (SceneKey.total_unit), NULL: none.
const char *scene_dimension(const char *name, const char **total);
bool scene_part_is_there(const SceneItems *items, const ScenePart *part, const Scene *scene,
                         int32_t k);

#endif
