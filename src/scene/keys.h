// SPDX-License-Identifier: GPL-2.0-or-later
// ONE table of every key of a scene: where it is stored, type, unit, default, range, a sentence.
// It drives parsing, --set, the "scene" object of run.json and `amontons info keys`.
#ifndef AMONTONS_SCENE_KEYS_H
#define AMONTONS_SCENE_KEYS_H

#include "base/hash.h"
#include "io/text/json_writer.h"
#include "scene/scene.h"

#include <math.h>
#include <stddef.h>
#include <stdio.h>

typedef enum SceneKeyType {
    KEY_NUMBER,   // double
    KEY_FLAG,   // bool: true or false
    KEY_TEXT,   // char[SCENE_TEXT_SIZE]
    KEY_NAME,   // char[GROUP_NAME_SIZE], not empty
    KEY_CHOICE,   // an enum, one of `choices`
    KEY_NUMBERS,   // SceneNumbers: a list of numbers
    KEY_NAMES,   // SceneNames: one name or a list of them; of `choices` where there are any
    KEY_PARAMETERS,   // mesh.set: keys of any name, each a number or a word
    KEY_ITEMS,   // a list or map of maps, as its `items` say (scene/item_kinds)
    KEY_BRANCHES,   // SceneRelaxation: a list of maps
    KEY_FIELDS,   // output.fields: none, or a map of the keys below it
} SceneKeyType;

// X(range, low, low itself allowed, high, which is allowed, in words)
#define SCENE_RANGES(X)                                                                            \
    X(RANGE_ANY, -INFINITY, false, INFINITY, "a number")                                           \
    X(RANGE_POSITIVE, 0, false, INFINITY, "a number > 0")                                          \
    X(RANGE_NOT_NEGATIVE, 0, true, INFINITY, "a number >= 0")                                      \
    X(RANGE_POISSON, -1, false, 0.5, "a number > -1 and <= 0.5")                                   \
    X(RANGE_PART, 0, false, 1, "a number > 0 and <= 1")                                            \
    X(RANGE_PART_OR_ZERO, 0, true, 1, "a number from 0 to 1")

typedef enum SceneRange {
#define X(range, low, low_allowed, high, words) range,
    SCENE_RANGES(X)
#undef X
} SceneRange;

typedef struct SceneItems SceneItems;

typedef struct SceneKey {
    const char *name;   // "material.young"
    SceneKeyType type;
    size_t offset;   // into Scene
    const char *unit;   // a dimension of base/units: "stress", "velocity", "1"
    SceneRange range;   // of a number
    const char *standard;   // default, as it would be written in YAML; NULL: none
    const char *sentence;   // what it means, for the reference
    const char *const *choices;   // NULL-terminated, in the order of the enum; NULL otherwise
    const SceneItems *items;   // of KEY_ITEMS
    bool must_be_given;   // of those without a default; friction.law says which of its keys must
    bool given_in_si;   // the default suits normalised scenes: with SI it must be given
    const char *hint;   // what else to do with a number of another dimension; NULL: nothing
    // Dimension of the same quantity of the whole block, where `unit` is per width of it; NULL: it
    // is not taken. `is_total`: offset of the bool in Scene that says which of them was given.
    const char *total_unit;
    size_t is_total;
} SceneKey;

// One word of an item: {group: a, mu_static: 0.5} has mu_static beside its group.
typedef struct ScenePart {
    const char *word;
    size_t offset;   // in the item
    size_t is_total;   // there: SceneKey.is_total of a key that has it
    size_t given;   // there: a bool, whether it is given; 0: where it is not 0 or empty
    const SceneKey *key;   // type, unit, range, choices; NULL: those of the key `like`.word
    bool must, shown;   // be given; also where it is not
} ScenePart;

// ONE table says what the items of each such key have: they are read by it (scene/items) and
// written (scene/json).
struct SceneItems {
    bool named;   // a map, whose keys name the items; else a list, where each has its `group`
    int32_t most;
    size_t count, first, size;   // in Scene: how many, and the first of them; bytes of each
    size_t name_size;   // of its name, with which it begins
    const char *like;   // the map of keys that an item gives otherwise; NULL: none
    const char *noun, *allowed, *item;   // "a traction"; what the value may be; what one may be
    const ScenePart *parts;   // ended by one without a word
};
extern const SceneItems scene_traction_items, scene_support_items, scene_contact_items,
    scene_state_items, scene_material_items, scene_probe_items;

// Returns true for types in whose place or below it numbers, and so formulas, may stand.
static inline bool scene_key_has_numbers(SceneKeyType type)
{
    return type == KEY_NUMBER || type == KEY_NUMBERS || type == KEY_PARAMETERS ||
           type == KEY_ITEMS || type == KEY_BRANCHES;
}

static inline bool scene_key_may_lack(const SceneKey *key)
{
    return !key->standard && !key->must_be_given;
}

// A number that need not be given: so a study varies whether it is there.
static inline bool scene_key_may_be_none(const SceneKey *key)
{
    return key->type == KEY_NUMBER && scene_key_may_lack(key);
}

const SceneKey *scene_keys(int32_t *count);
int32_t scene_key_index(const char *name);   // -1: no such key
bool scene_key_is_group(const char *name);   // "material", "time.until"
// A key with names of one's own below it: "mesh.set.nx", "materials.pads.young". *part: what is
// left of the name, "nx", "pads.young"; -1: no such key.
int32_t scene_key_above(const char *name, const char **part);
// The known key or group (of keys) nearest to `name`; NULL when none is near.
const char *scene_key_nearest(const char *name);
// Refuses `name`, which is no key of a scene, at the key of `node`: says what takes the place of a
// key that is gone, else which known one is nearest. Returns false.
bool scene_key_refuse(const YamlDocument *document, YamlNode node, const char *name, Error *err);
// Says how to do without a key of earlier versions; NULL: `name` is none. Static storage.
const char *scene_key_instead(const char *name);

// Least and largest size of a number that is not 0. Beyond them a product of some numbers is 0 or
// infinite, and loops that double a step do not end.
static const double SCENE_SMALLEST = 1e-60, SCENE_LARGEST = 1e60;
static inline bool scene_size_holds(double value)
{
    double size = fabs(value);
    return size == 0 || (size >= SCENE_SMALLEST && size <= SCENE_LARGEST);
}

bool scene_range_holds(SceneRange range, double value);
const char *scene_range_words(SceneRange range);
// Allowed values of the key in words, for errors and the reference: "one of stress, strain".
void scene_key_allowed(const SceneKey *key, char *words, int32_t size);

// The value of `key` in `scene` as it would be written in YAML.
void scene_key_value(const SceneKey *key, const Scene *scene, char *words, int32_t size);

// The same as an item called `name`.
void scene_write_value(const SceneKey *key, const Scene *scene, JsonWriter *json, const char *name);

// Every parameter after defaults, as the object `name` of the document: the scene's own keys,
// nested as in YAML, so that it can be read again as a scene. mesh.file as seen from `folder`, in
// which the document stands.
void scene_write_json(const Scene *scene, JsonWriter *json, const char *name, const char *folder);

// Adds the keys that count, with their values.
bool scene_hash(const Scene *scene, bool (*counts)(const char *key), Hash *hash, Error *err);

// The reference: one Markdown table row a key.
void scene_write_reference(FILE *out);

#endif
