// SPDX-License-Identifier: GPL-2.0-or-later
// ONE table of every key of a scene: where it is stored, type, unit, default, range, a sentence.
// It drives parsing, --set, the "scene" object of run.json and `amontons info keys`.
#ifndef AMONTONS_RUN_SCENE_KEYS_H
#define AMONTONS_RUN_SCENE_KEYS_H

#include "io/json_writer.h"
#include "run/scene.h"

#include <stddef.h>
#include <stdio.h>

typedef enum SceneKeyType { KEY_NUMBER, KEY_FLAG, KEY_TEXT, KEY_CHOICE, KEY_SPECIAL } SceneKeyType;

typedef struct SceneKey {
    const char *name;            // "material.young"
    SceneKeyType type;
    size_t offset;               // into Scene
    const char *unit;            // dimension in words: "stress", "length/time", "1"
    const char *standard;        // default, as it would be written in YAML; NULL: must be given
    double low, high;            // closed range of a number
    bool low_open;               // the low end itself is not allowed
    const char *const *choices;  // NULL-terminated, in the order of the enum; NULL otherwise
    const char *sentence;        // what it means, for the reference
} SceneKey;

const SceneKey *scene_keys(int32_t *count);

// Every parameter after defaults, as the object `name` of the document.
void scene_write_json(const Scene *scene, JsonWriter *json, const char *name);

// The reference: one Markdown table row a key.
void scene_write_reference(FILE *out);

#endif
