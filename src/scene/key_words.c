// SPDX-License-Identifier: GPL-2.0-or-later
// Values of a scene as text, the reference of all keys, and the hash of a scene. The hash takes
// numbers by their bits and all else as it would be written in YAML.
#include "scene/keys.h"

#include "base/memory.h"
#include "io/files/text_file.h"

#include <stdio.h>
#include <string.h>

// Cut where it does not fit, as `amontons info` shows it. A text stands in quotes, a name does not.
void scene_key_value(const SceneKey *key, const Scene *scene, char *words, int32_t size)
{
    Error unseen = {0};
    words[0] = 0;
    JsonWriter *json = key->type == KEY_TEXT ? json_create(NULL, &unseen)
                                             : json_create_flow(&unseen);
    if (!json) return;
    scene_write_value(key, scene, json, NULL);
    char *text = json_take(json, &unseen);
    if (text) snprintf(words, (size_t)size, "%s", text);
    words[strcspn(words, "\n")] = 0;
    memory_free(text);
}

// The table of keys in docs/scenes.md; a test compares the two.
void scene_write_reference(FILE *out)
{
    int32_t count = 0;
    const SceneKey *keys = scene_keys(&count);
    fprintf(out, "| key | default | allowed | dimension | meaning |\n"
                 "|---|---|---|---|---|\n");
    for (int32_t k = 0; k < count; k++) {
        char allowed[300];
        scene_key_allowed(&keys[k], allowed, sizeof allowed);
        fprintf(out, "| `%s` | ", keys[k].name);
        if (scene_key_may_lack(&keys[k]))
            fprintf(out, "none");
        else if (!keys[k].standard)
            fprintf(out, "must be given");
        else
            fprintf(out, "`%s`%s", keys[k].standard,
                    keys[k].given_in_si ? "; with SI must be given" : "");
        bool is_number = keys[k].type == KEY_NUMBER || keys[k].type == KEY_NUMBERS;
        fprintf(out, " | %s | %s | %s |\n", allowed, is_number ? keys[k].unit : "",
                keys[k].sentence);
    }
}

// --- hash ---------------------------------------------------------------------------------------

enum { VALUE_SIZE = 8192, BYTES_MAX = 1 << 28 };

// The functions of a friction law that is a plug-in, the points of a profile: the file's content.
static bool hash_file(const char *path, Hash *hash, Error *err)
{
    char *bytes = NULL;
    int32_t size = 0;
    if (!*path) return true;
    TRY(text_file_bytes(path, BYTES_MAX, &bytes, &size, err));
    hash_bytes(hash, bytes, (size_t)size);
cleanup:
    memory_free(bytes);
    return error_is_clean(err);
}

bool scene_hash(const Scene *scene, bool (*counts)(const char *key), Hash *hash, Error *err)
{
    int32_t count = 0;
    const SceneKey *keys = scene_keys(&count);
    char *words = NEW_ARRAY(char, VALUE_SIZE, err);
    TRY(words);
    TRY(hash_file(scene->friction_keys.file, hash, err));
    TRY(hash_file(scene->contact.profile, hash, err));
    for (int32_t k = 0; k < count; k++) {
        const void *field = (const char *)scene + keys[k].offset;
        if (!counts(keys[k].name)) continue;
        hash_text(hash, keys[k].name);
        if (keys[k].type == KEY_NUMBER) {
            hash_number(hash, *(const double *)field);
            if (keys[k].total_unit)
                hash_number(hash, *(const bool *)((const char *)scene + keys[k].is_total));
        } else if (keys[k].type == KEY_PARAMETERS) {
            for (int32_t i = 0; i < scene->mesh.parameter_count; i++) {
                hash_text(hash, scene->mesh.parameters[i].name);
                hash_text(hash, scene->mesh.parameters[i].text);
                hash_number(hash, scene->mesh.parameters[i].value);
            }
        } else {
            scene_key_value(&keys[k], scene, words, VALUE_SIZE);
            hash_text(hash, words);
        }
    }
cleanup:
    memory_free(words);
    return error_is_clean(err);
}
