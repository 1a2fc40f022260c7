// SPDX-License-Identifier: GPL-2.0-or-later
// One value of a scene file, checked against its key and stored. Called by
// scene/scene_read and scene/items.
#ifndef AMONTONS_SCENE_VALUE_H
#define AMONTONS_SCENE_VALUE_H

#include "io/text/yaml_document.h"
#include "scene/keys.h"

// Place of a value in the file. `part`: the parameter's name when one of mesh.set is set alone,
// else NULL.
typedef struct SceneValue {
    const YamlDocument *document;
    YamlNode node;
    const char *part;
} SceneValue;

// Stores the value in the field of `key`. scene->units must be known already. Errors (ERROR_INPUT)
// show the place and say what is allowed.
bool scene_value_set(const SceneKey *key, const SceneValue *value, Scene *scene, Error *err);

// Makes the field of a key without a default zero, as when it is not given.
void scene_value_clear(const SceneKey *key, Scene *scene);

#endif
