// SPDX-License-Identifier: GPL-2.0-or-later
// The words of an item are set by keys that point at their places in it: units, ranges and messages
// are those of keys.
#include "scene/items.h"

#include "scene/friction_law.h"

#include <ctype.h>
#include <string.h>

enum { PATH_SIZE = 160, ALLOWED_SIZE = 300 };

int32_t scene_items_count(const SceneItems *items, const Scene *scene)
{
    return *(const int32_t *)((const char *)scene + items->count);
}

const char *scene_item(const SceneItems *items, const Scene *scene, int32_t k)
{
    return (const char *)scene + items->first + (size_t)k * items->size;
}

static char *item_of(const SceneItems *items, Scene *scene, int32_t k)
{
    return (char *)scene + items->first + (size_t)k * items->size;
}

SceneKey scene_part_key(const SceneItems *items, const ScenePart *part, int32_t k, const char *name)
{
    char like[40];
    int32_t count = 0;
    snprintf(like, sizeof like, "%s.%s", items->like ? items->like : "", part->word);
    SceneKey key = part->key ? *part->key : scene_keys(&count)[scene_key_index(like)];
    key.name = name;
    key.offset = items->first + (size_t)k * items->size + part->offset;
    if (part->is_total) key.is_total = items->first + (size_t)k * items->size + part->is_total;
    return key;
}

bool scene_part_is_there(const SceneItems *items, const ScenePart *part, const Scene *scene,
                         int32_t k)
{
    const char *item = scene_item(items, scene, k);
    double number = 0;
    if (part->given) return *(const bool *)(item + part->given);
    if (scene_part_key(items, part, k, "").type == KEY_TEXT) return item[part->offset] != 0;
    memcpy(&number, item + part->offset, sizeof number);
    return number != 0;
}

static const ScenePart *find_part(const SceneItems *items, const char *word)
{
    for (const ScenePart *part = items->parts; part->word; part++)
        if (strcmp(part->word, word) == 0) return part;
    return NULL;
}

bool scene_part_has_numbers(const SceneItems *items, const char *word)
{
    const ScenePart *part = find_part(items, word);
    return !part || scene_key_has_numbers(scene_part_key(items, part, 0, "").type);
}

const char *scene_dimension(const char *name, const char **total)
{
    int32_t count = 0, index = scene_key_index(name);
    const SceneKey *keys = scene_keys(&count);
    const char *part = NULL, *dot = strrchr(name, '.');
    *total = NULL;
    if (index >= 0 && keys[index].type == KEY_NUMBER) {
        *total = keys[index].total_unit;
        return keys[index].unit;
    }
    if (index >= 0 || (index = scene_key_above(name, &part)) < 0) return NULL;
    const SceneKey *key = &keys[index];
    if (key->type == KEY_PARAMETERS) return key->unit;

    // Words of branches stand in lists of their own: "material.relaxation.0.time",
    // "materials.pads.relaxation.0.time".
    const char *word = dot + 1, *of_branch = NULL;
    if (key->type == KEY_BRANCHES || strstr(part, ".relaxation."))
        of_branch = strcmp(word, "time") == 0                                 ? "time"
                    : strcmp(word, "shear") == 0 || strcmp(word, "bulk") == 0 ? "stress"
                                                                              : NULL;
    const ScenePart *found = key->items ? find_part(key->items, dot + 1) : NULL;
    if (of_branch || !found) return of_branch;
    SceneKey own = scene_part_key(key->items, found, 0, "");
    *total = own.total_unit;
    return own.type == KEY_NUMBER ? own.unit : NULL;
}

// "load.tractions", or of items with names "materials.pads".
static void path_of(const SceneKey *key, const char *item, char path[PATH_SIZE])
{
    bool named = key->items->named;
    snprintf(path, PATH_SIZE, "%s%s%.70s", key->name, named ? "." : "", named ? item : "");
}

// One word of item number k: its own key, or value->part.
static bool set_word(const SceneKey *key, int32_t k, const SceneValue *value, Scene *scene,
                     Error *err)
{
    static const SceneKey name_key = {.type = KEY_NAME};
    static const ScenePart group = {.word = "group", .key = &name_key, .must = true, .shown = true};
    char path[PATH_SIZE], name[2 * PATH_SIZE];
    const SceneItems *items = key->items;
    char *item = item_of(items, scene, k);
    const char *word = value->part ? value->part : yaml_key(value->document, value->node);
    const char *dot = value->part ? strchr(word, '.') : NULL;   // "relaxation.0.shear"
    char first[GROUP_NAME_SIZE];
    if (dot) {
        int length = dot - word < GROUP_NAME_SIZE ? (int)(dot - word) : GROUP_NAME_SIZE - 1;
        snprintf(first, sizeof first, "%.*s", length, word);
        word = first;
    }
    bool is_group = !items->named && strcmp(word, "group") == 0;
    const ScenePart *part = is_group ? &group : find_part(items, word);
    path_of(key, item, path);
    if (!part) {
        // The words that are allowed; one that is a key of the whole block is told so.
        char allowed[ALLOWED_SIZE] = "", whole[PATH_SIZE];
        const char *given = value->part ? value->part : word;
        for (const ScenePart *one = items->parts; one->word; one++) {
            size_t used = strlen(allowed);
            snprintf(allowed + used, sizeof allowed - used, "%s%s",
                     used || !items->named ? ", " : "", one->word);
        }
        snprintf(whole, sizeof whole, "%s.%.60s", items->like ? items->like : "", given);
        bool known = items->like && scene_key_index(whole) >= 0;
        if (scene_key_instead(whole))
            return scene_key_refuse(value->document, value->node, whole, err);
        return yaml_key_error(value->document, value->node, err,
                              "%s: unknown key `%.60s`%s%s%s; allowed: %s%s", path, given,
                              known ? ", which is for the whole block (" : "", known ? whole : "",
                              known ? ")" : "", items->named ? "" : "group", allowed);
    }
    snprintf(name, sizeof name, "%s.%s", path, word);
    SceneKey own = scene_part_key(items, part, k, name);
    if (own.type == KEY_TEXT && !*yaml_text(value->document, value->node))
        return yaml_refuse(value->document, value->node, name, "a text", err);
    if (part->given) *(bool *)(item + part->given) = true;
    SceneValue one = *value;
    one.part = dot ? dot + 1 : NULL;
    return scene_value_set(&own, &one, scene, err);
}

// All of a map, {mu_static: 0.5}. An empty one is an item without words.
static bool set_item(const SceneKey *key, int32_t k, const SceneValue *value, Scene *scene,
                     Error *err)
{
    char path[PATH_SIZE], allowed[ALLOWED_SIZE];
    const SceneItems *items = key->items;
    const YamlDocument *document = value->document;
    char *item = item_of(items, scene, k);
    YamlKind kind = yaml_kind(document, value->node);
    memset(item + items->name_size, 0, items->size - items->name_size);
    path_of(key, item, path);
    if (kind != YAML_MAP && kind != YAML_NOTHING) {
        bool whole = items->like && items->named && find_part(items, item);
        snprintf(allowed, sizeof allowed, "a map %s%s%s%s%s%s", items->item,
                 whole ? " (that of the whole block is `" : "", whole ? items->like : "",
                 whole ? "." : "", whole ? item : "", whole ? "`)" : "");
        return yaml_refuse(document, value->node, path, allowed, err);
    }
    YAML_EACH (word, document, value->node) {
        SceneValue one = {.document = document, .node = word};
        if (!set_word(key, k, &one, scene, err)) return false;
    }
    const char *lacks = *item ? NULL : "group";
    for (const ScenePart *part = items->parts; part->word && !lacks; part++)
        if (part->must && !scene_part_is_there(items, part, scene, k)) lacks = part->word;
    return !lacks || yaml_error(document, value->node, err, "%s: %s needs its `%s`", path,
                                items->noun, lacks);
}

// The number of the item that `name` [length] names, as it is or a new one; of a list a new one.
// -1: it is refused.
static int32_t take_item(const SceneKey *key, const char *name, size_t length,
                         const SceneValue *value, Scene *scene, Error *err)
{
    const SceneItems *items = key->items;
    int32_t *count = (int32_t *)(void *)((char *)scene + items->count);
    bool fits = !items->named || (length > 0 && length < items->name_size);
    for (int32_t k = 0; items->named && fits && k < *count; k++) {
        const char *known = scene_item(items, scene, k);
        if (strlen(known) == length && memcmp(known, name, length) == 0) return k;
    }
    if (!fits || *count == items->most) {
        yaml_key_error(value->document, value->node, err,
                       "%s: at most %d items, with names of 1 to %d bytes", key->name, items->most,
                       (int)items->name_size - 1);
        return -1;
    }

    // A name of a state of friction.state has letters, digits and _, and no other meaning in a
    // formula: names that every formula or scene/friction_law uses are taken.
    if (items == &scene_state_items) {
        static const char *const taken[] = {"v",     "p",   "sqrt", "exp", "log",   "tanh",
                                            "asinh", "abs", "min",  "max", "round", "points"};
        char word[GROUP_NAME_SIZE];
        snprintf(word, sizeof word, "%.*s", (int)length, name);
        bool can_name = isalpha((unsigned char)*word) && strlen(word) < STATE_NAME_SIZE &&
                        scene_friction_number(word) < 0;
        for (const char *at = word; *at; at++)
            can_name = can_name && (isalnum((unsigned char)*at) || *at == '_');
        for (size_t k = 0; k < sizeof taken / sizeof *taken; k++)
            can_name = can_name && strcmp(word, taken[k]) != 0;
        if (!can_name) {
            yaml_key_error(value->document, value->node, err,
                           "%s: `%.40s` cannot be the name of a state; allowed: letters, digits "
                           "and _, at most 31, and not v, p, a function or a number of friction "
                           "(mu_S, D_c, a, b, ...)",
                           key->name, word);
            return -1;
        }
    }
    char *item = item_of(items, scene, (*count)++);
    memset(item, 0, items->size);
    memcpy(item, name, items->named ? length : 0);
    return *count - 1;
}

bool scene_items_set(const SceneKey *key, const SceneValue *value, Scene *scene, Error *err)
{
    const SceneItems *items = key->items;
    const YamlDocument *document = value->document;
    YamlKind kind = yaml_kind(document, value->node);
    if (value->part) {
        // The rest of the path of a --set: an item's map, or one word of an item. Where the words
        // of an item begin in "layer.young" and "layer.relaxation.0.shear"; names of items may have
        // dots. NULL: nowhere.
        SceneValue one = {.document = document, .node = value->node};
        const char *found = strstr(value->part, ".relaxation.");
        const char *dot = found ? found : strrchr(value->part, '.');
        size_t length = kind == YAML_MAP ? strlen(value->part)
                        : dot            ? (size_t)(dot - value->part)
                                         : 0;
        int32_t k = take_item(key, value->part, length, &one, scene, err);
        if (k < 0) return false;
        if (kind == YAML_MAP) return set_item(key, k, &one, scene, err);
        one.part = dot + 1;
        return set_word(key, k, &one, scene, err);
    }
    *(int32_t *)(void *)((char *)scene + items->count) = 0;
    if (kind == YAML_NOTHING) return true;
    if (kind != (items->named ? YAML_MAP : YAML_LIST) ||
        yaml_count(document, value->node) > items->most)
        return yaml_refuse(document, value->node, key->name, items->allowed, err);
    YAML_EACH (node, document, value->node) {
        SceneValue one = {.document = document, .node = node};
        const char *name = yaml_key(document, node);
        int32_t k = take_item(key, name, strlen(name), &one, scene, err);
        if (k < 0 || !set_item(key, k, &one, scene, err)) return false;
    }

    // The axes of a direction.
    static const bool along[][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}};
    for (int32_t k = 0; k < scene->load.support_count; k++) {
        SceneSupport *support = &scene->load.supports[k];
        support->x = along[support->direction][0];
        support->y = along[support->direction][1];
        support->z = along[support->direction][2];
    }

    return true;
}
