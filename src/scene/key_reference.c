// SPDX-License-Identifier: GPL-2.0-or-later
// Values of a scene as text, and the reference of all keys.
#include "scene/keys.h"

#include "base/memory.h"

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
