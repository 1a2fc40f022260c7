// SPDX-License-Identifier: GPL-2.0-or-later
// The "scene" object of run.json. Maps are opened and closed as the key table is gone through.
// Keys of one map stand together in the table (scene/keys), so that a map that was left is
// never needed again. What is written can be read as a scene, JSON being YAML.
#include "scene/keys.h"

#include "base/units.h"
#include "io/files/folder.h"
#include "scene/items.h"

#include <string.h>

enum { LEVELS_MAX = 4 };

// If output.fields is a map, its keys follow by themselves. Words of items are written by this
// function, too.
void scene_write_value(const SceneKey *key, const Scene *scene, JsonWriter *json, const char *name)
{
    const void *field = (const char *)scene + key->offset;
    const SceneNumbers *numbers = field;
    const SceneNames *names = field;
    char number[60];
    const SceneRelaxation *relaxation = field;
    switch (key->type) {
    case KEY_NUMBER:
        if (key->total_unit && *(const bool *)((const char *)scene + key->is_total)) {
            const char *unit = unit_examples(key->total_unit);
            snprintf(number, sizeof number, "%.17g %.*s", *(const double *)field,
                     (int)strcspn(unit, ","), unit);
            json_text(json, name, number);
        } else
            json_number(json, name, *(const double *)field);
        return;
    case KEY_FLAG:
        json_boolean(json, name, *(const bool *)field);
        return;
    case KEY_TEXT:
    case KEY_NAME:
        json_text(json, name, field);
        return;
    case KEY_CHOICE:
        json_text(json, name, key->choices[*(const int32_t *)field]);
        return;
    case KEY_NUMBERS:
        json_begin_list(json, name);
        for (int32_t i = 0; i < numbers->count; i++) json_number(json, NULL, numbers->value[i]);
        json_end(json);
        return;
    case KEY_NAMES:
        json_begin_list(json, name);
        for (int32_t i = 0; i < names->count; i++) json_text(json, NULL, names->name[i]);
        json_end(json);
        return;
    case KEY_PARAMETERS:
        json_begin_object(json, name);
        for (int32_t i = 0; i < scene->mesh.parameter_count; i++) {
            const MeshParameter *parameter = &scene->mesh.parameters[i];
            if (*parameter->text)
                json_text(json, parameter->name, parameter->text);
            else
                json_number(json, parameter->name, parameter->value);
        }
        json_end(json);
        return;
    case KEY_ITEMS:
        (key->items->named ? json_begin_object : json_begin_list)(json, name);
        for (int32_t k = 0; k < scene_items_count(key->items, scene); k++) {
            const char *item = scene_item(key->items, scene, k);
            json_begin_object(json, key->items->named ? item : NULL);
            if (!key->items->named) json_text(json, "group", item);
            for (const ScenePart *part = key->items->parts; part->word; part++) {
                SceneKey own = scene_part_key(key->items, part, k, part->word);
                if (part->shown || scene_part_is_there(key->items, part, scene, k))
                    scene_write_value(&own, scene, json, part->word);
            }
            json_end(json);
        }
        json_end(json);
        return;
    case KEY_BRANCHES:
        json_begin_list(json, name);
        for (int32_t i = 0; i < relaxation->count; i++)
            json_object_of(json, NULL, {"time", relaxation->branch[i].time},
                           {"shear", relaxation->branch[i].shear},
                           {"bulk", relaxation->branch[i].bulk});
        json_end(json);
        return;
    case KEY_FIELDS:
        json_text(json, name, scene->output.fields ? "as below" : "none");
        return;
    }
}

// Goes through the keys with a stack of the maps that are open: those the next key does not share
// are closed, those it has more are opened.
void scene_write_json(const Scene *scene, JsonWriter *json, const char *name, const char *folder)
{
    static const char *const files[] = {"mesh.file", "friction.file", "contact.profile",
                                        "output.compare"};
    int32_t count = 0, depth = 0;
    const SceneKey *keys = scene_keys(&count);
    char open[LEVELS_MAX][GROUP_NAME_SIZE] = {0};   // names of the maps that are open
    json_begin_object(json, name);
    for (int32_t k = 0; k < count; k++) {
        // A key that may be left out and was has no value to show.
        bool part_of_fields = strncmp(keys[k].name, "output.fields.", 14) == 0;
        bool left_out = !keys[k].standard && !scene->given[k];
        if (keys[k].type == KEY_FIELDS ? scene->output.fields
                                       : (part_of_fields && !scene->output.fields) || left_out)
            continue;
        const char *rest = keys[k].name;
        int32_t shared = 0;
        for (; shared < depth; shared++) {
            size_t length = strlen(open[shared]);
            if (strncmp(rest, open[shared], length) != 0 || rest[length] != '.') break;
            rest += length + 1;
        }
        for (; depth > shared; depth--) json_end(json);
        for (const char *dot = strchr(rest, '.'); dot; dot = strchr(rest, '.')) {
            memset(open[depth], 0, sizeof open[depth]);
            memcpy(open[depth], rest, (size_t)(dot - rest));
            json_begin_object(json, open[depth++]);
            rest = dot + 1;
        }
        bool is_file = false;
        for (size_t n = 0; n < sizeof files / sizeof *files; n++)
            is_file = is_file || strcmp(keys[k].name, files[n]) == 0;
        if (!is_file) {
            scene_write_value(&keys[k], scene, json, rest);
            continue;
        }
        char file[SCENE_TEXT_SIZE];   // found from the document, wherever the run was started
        folder_relative(folder, (const char *)scene + keys[k].offset, file, sizeof file);
        json_text(json, rest, file);
    }
    for (; depth >= 0; depth--) json_end(json);
}
