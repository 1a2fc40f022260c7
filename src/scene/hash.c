// SPDX-License-Identifier: GPL-2.0-or-later
// Numbers by their bits, all else as it would be written in YAML.
#include "scene/keys.h"

#include "base/memory.h"
#include "io/files/text_file.h"

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
