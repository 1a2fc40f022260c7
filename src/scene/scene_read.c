// SPDX-License-Identifier: GPL-2.0-or-later
// A scene is read in four steps: the defaults; what the file gives; what the overrides give; the
// checks. Settings are gathered first and stored after, because `units` must be known before any
// number is.
//
// A value that is a formula (`= 6 * load.pressure`), wherever a number may stand, is left out when
// settings are stored first. Formulas are then worked out, each after those that it depends on,
// what they give stands in for their texts, and all settings are stored again. Formulas of settings
// from outside of the file follow one by one.
//
// A later setting wins, key by key; a map given whole (--set time.until={t: 3}) first gives its
// keys their defaults back. `places` remembers where each value stands, for errors of the checks.
#include "scene/scene.h"

#include "base/memory.h"
#include "io/files/open_file.h"
#include "scene/check.h"
#include "scene/formulas.h"
#include "scene/friction_law.h"
#include "scene/items.h"
#include "scene/keys.h"
#include "scene/material_file.h"
#include "scene/profile.h"
#include "scene/value.h"

#include <stdio.h>
#include <string.h>

enum { SETTINGS_MAX = 4 * SCENE_KEYS_MAX, FORMULAS_MAX = 256 };

typedef struct Setting {
    int32_t key;   // of scene_keys(); -1: give `group` its defaults back
    SceneValue value;
    char group[SCENE_KEY_SIZE];
} Setting;

// A formula over the others, in the place of a number.
typedef struct FormulaSetting {
    char name[SCENE_KEY_SIZE];   // as after --set: "mesh.set.height"; in a list "load.program.t.0"
    SceneValue value;
    int32_t before;   // settings that were gathered before it; later ones replace it
} FormulaSetting;

struct SceneSource {
    char path[SCENE_TEXT_SIZE];
    const SceneKey *keys;   // [key_count]
    int32_t key_count;
    YamlDocument *defaults;   // a list of the keys' defaults, in their order
    YamlDocument *file;
    Setting *settings;   // [setting_count] of SETTINGS_MAX, later ones win: first the file's
    int32_t setting_count, file_count;
    FormulaSetting *formulas;   // [formula_count] of FORMULAS_MAX, in their order
    int32_t formula_count, file_formulas;
    SceneValue places[SCENE_KEYS_MAX];   // where each value of the scene at hand stands
    bool trusted;   // Scene.trusted of what is read
};

// --- gathering ----------------------------------------------------------------------------------

// SETTINGS_MAX is several times what a scene with every key has.
static bool add_setting(SceneSource *source, const Setting *setting, Error *err)
{
    if (source->setting_count == SETTINGS_MAX)
        return REFUSE(err, "more than %d settings of keys", SETTINGS_MAX);
    source->settings[source->setting_count++] = *setting;
    return true;
}

static bool gather(SceneSource *source, const char *name, const SceneValue *value, Error *err);

// An empty map (`load:` alone) is taken as one without keys.
static bool gather_children(SceneSource *source, const char *name, const SceneValue *value,
                            Error *err)
{
    const YamlDocument *document = value->document;
    YamlKind kind = yaml_kind(document, value->node);
    if (kind != YAML_MAP && kind != YAML_NOTHING)
        return yaml_refuse(document, value->node, name, "a map of keys", err);
    YAML_EACH (item, document, value->node) {
        char path[SCENE_KEY_SIZE];
        SceneValue child = {.document = document, .node = item};
        snprintf(path, sizeof path, "%s%s%.60s", name, *name ? "." : "", yaml_key(document, item));
        if (!gather(source, path, &child, err)) return false;
    }
    return true;
}

// Formulas in the value of a key, at whatever depth of its lists and maps: "load.pressure",
// "materials.pads.young", "material.relaxation.0.shear", "load.tractions.1.x". Words of items that
// take texts have none.
static bool gather_formulas(SceneSource *source, const SceneItems *items, const char *name,
                            const SceneValue *value, Error *err)
{
    YamlKind kind = yaml_kind(value->document, value->node);
    int32_t number = 0;
    if (scene_is_formula(value->document, value->node)) {
        if (source->formula_count == FORMULAS_MAX)
            return yaml_error(value->document, value->node, err, "%s: more than %d formulas", name,
                              FORMULAS_MAX);
        FormulaSetting *formula = &source->formulas[source->formula_count++];
        *formula = (FormulaSetting){.value = *value, .before = source->setting_count};
        snprintf(formula->name, sizeof formula->name, "%s", name);
        return true;
    }
    if (kind != YAML_LIST && kind != YAML_MAP) return true;
    YAML_EACH (node, value->document, value->node) {
        char path[SCENE_KEY_SIZE], place[16];
        SceneValue child = {.document = value->document, .node = node};
        const char *word = yaml_key(value->document, node);
        snprintf(place, sizeof place, "%d", number++);
        snprintf(path, sizeof path, "%.60s.%.30s", name, kind == YAML_LIST ? place : word);
        bool is_text = kind == YAML_MAP && items &&
                       yaml_kind(value->document, node) == YAML_SCALAR &&
                       !scene_part_has_numbers(items, word);
        if (!is_text && !gather_formulas(source, items, path, &child, err)) return false;
    }
    return true;
}

// Adds the setting of a key, with the formulas that are in it.
static bool gather_key(SceneSource *source, const char *name, const Setting *setting, Error *err)
{
    const SceneKey *key = &source->keys[setting->key];
    if (!add_setting(source, setting, err)) return false;
    return !scene_key_has_numbers(key->type) ||
           gather_formulas(source, key->items, name, &setting->value, err);
}

// Turns the value standing under `name` into settings of keys.
static bool gather(SceneSource *source, const char *name, const SceneValue *value, Error *err)
{
    Setting setting = {.key = scene_key_index(name), .value = *value};
    if (setting.key >= 0) {
        if (!gather_key(source, name, &setting, err)) return false;
        bool has_children = source->keys[setting.key].type == KEY_FIELDS &&
                            yaml_kind(value->document, value->node) == YAML_MAP;
        return !has_children || gather_children(source, name, value, err);
    }
    if (scene_key_is_group(name)) return gather_children(source, name, value, err);
    return scene_key_refuse(value->document, value->node, name, err);
}

// A value given for `name` from outside of the file; `mesh.set.NAME` sets a single parameter,
// `materials.NAME.young` and `material.relaxation.0.shear` a single number.
static bool gather_outside(SceneSource *source, const SceneSetting *given, Error *err)
{
    const char *name = given->key;
    Setting setting = {.key = -1, .value = {.document = given->document, .node = given->node}};
    if (strlen(name) >= SCENE_KEY_SIZE)
        return REFUSE(err, "%.80s...: unknown key (`amontons info keys` lists them all)", name);
    setting.key = scene_key_above(name, &setting.value.part);
    if (setting.key >= 0) {
        snprintf(setting.group, sizeof setting.group, "%s", setting.value.part);
        return gather_key(source, name, &setting, err);
    }
    if (scene_key_is_group(name) && scene_key_index(name) < 0) {
        snprintf(setting.group, sizeof setting.group, "%s", name);
        if (!add_setting(source, &setting, err)) return false;
    }
    return gather(source, name, &setting.value, err);
}

bool scene_override_parse(const char *text, char key[SCENE_KEY_SIZE], YamlDocument **document,
                          Error *err)
{
    char shown[SCENE_KEY_SIZE + 8];
    const char *equals = strchr(text, '=');
    if (!equals || equals == text || equals - text >= SCENE_KEY_SIZE)
        return REFUSE(err, "--set %.80s: wanted is key=value, as in load.pressure=0.006", text);
    snprintf(key, SCENE_KEY_SIZE, "%.*s", (int)(equals - text), text);
    snprintf(shown, sizeof shown, "--set %s", key);
    return yaml_parse(shown, text, (int32_t)(equals - text) + 1, document, err);
}

// --- storing ------------------------------------------------------------------------------------

static bool store_value(const SceneKey *key, const SceneValue *value, Scene *scene, Error *err)
{
    return (key->items ? scene_items_set : scene_value_set)(key, value, scene, err);
}

// Gives `group` and every key below it ("": all) its default; a key without one becomes zero.
static bool store_defaults(SceneSource *source, const char *group, Scene *scene, Error *err)
{
    size_t length = strlen(group);
    YamlNode node = yaml_first(source->defaults, YAML_ROOT);
    for (int32_t k = 0; k < source->key_count; k++) {
        const SceneKey *key = &source->keys[k];
        SceneValue value = {.document = source->defaults, .node = node};
        node = yaml_next(source->defaults, node);
        bool is_in = strncmp(key->name, group, length) == 0 &&
                     (key->name[length] == '.' || key->name[length] == 0);
        if (length && !is_in) continue;
        scene->given[k] = false;
        scene->line[k] = 0;
        source->places[k] = (SceneValue){0};
        if (!key->standard) scene_value_clear(key, scene);
        if (key->standard && !store_value(key, &value, scene, err)) return false;
    }
    return true;
}

static bool store_setting(SceneSource *source, const Setting *setting, Scene *scene, Error *err)
{
    static const char fields[] = "output.fields";
    if (setting->key < 0) return store_defaults(source, setting->group, scene, err);
    const SceneKey *key = &source->keys[setting->key];
    SceneValue value = setting->value;
    if (value.part) value.part = setting->group;
    bool none = scene_key_may_be_none(key) &&
                yaml_kind(value.document, value.node) == YAML_SCALAR &&
                strcmp(yaml_text(value.document, value.node), "none") == 0;
    if (none) return store_defaults(source, key->name, scene, err);
    if (key->type == KEY_FIELDS && !store_defaults(source, fields, scene, err)) return false;
    if (!store_value(key, &value, scene, err)) return false;
    bool is_part_of_fields = strncmp(key->name, fields, strlen(fields)) == 0 &&
                             key->type != KEY_FIELDS;
    if (is_part_of_fields) {
        scene->output.fields = true;
        scene->given[scene_key_index(fields)] = true;
    }
    scene->given[setting->key] = true;
    bool inside = value.document == source->file;
    scene->line[setting->key] = inside ? yaml_line(value.document, value.node) : 0;
    source->places[setting->key] = value;
    return true;
}

// `units` first, wherever it stands: numbers are read by it.
static bool store_settings(SceneSource *source, Scene *scene, Error *err)
{
    int32_t units = scene_key_index("units");
    if (!store_defaults(source, "", scene, err)) return false;
    for (int32_t i = 0; i < source->setting_count; i++)
        if (source->settings[i].key == units &&
            !store_setting(source, &source->settings[i], scene, err))
            return false;
    for (int32_t i = 0; i < source->setting_count; i++)
        if (source->settings[i].key != units &&
            !store_setting(source, &source->settings[i], scene, err))
            return false;
    return true;
}

// Settings from number `first` on.
static bool store_from(SceneSource *source, int32_t first, Scene *scene, Error *err)
{
    for (int32_t i = first; i < source->setting_count; i++)
        if (!store_setting(source, &source->settings[i], scene, err)) return false;
    return true;
}

// --- formulas -----------------------------------------------------------------------------------

// Numbers of a scene of which some formulas are not worked out yet.
typedef struct Numbers {
    const SceneSource *source;
    const Scene *scene;
    const bool *waiting;   // [formula_count]
} Numbers;

static bool find_number(const void *context, const char *name, double *value)
{
    const Numbers *numbers = context;
    for (int32_t k = 0; k < numbers->source->formula_count; k++)
        if (numbers->waiting[k] && strcmp(numbers->source->formulas[k].name, name) == 0)
            return false;
    if (*numbers->scene->material.from && strcmp(name, "material.young") == 0) return false;
    return scene_number(numbers->scene, name, value);
}

// Formulas stand for themselves again.
static void forget_values(const SceneSource *source)
{
    Error none = {0};   // nothing is allocated
    for (int32_t k = 0; k < source->formula_count; k++)
        yaml_stand_in(source->formulas[k].value.document, source->formulas[k].value.node, NULL,
                      &none);
}

// Works out formulas over what else the scene has, in rounds: all that name none that is waiting,
// after which settings are stored again. ERROR_INPUT: what is wrong with one, or that some wait
// for each other.
static bool work_out_formulas(SceneSource *source, Scene *scene, Error *err)
{
    bool waiting[FORMULAS_MAX] = {false}, known[FORMULAS_MAX];
    int32_t left = 0, found = 1;
    Numbers numbers = {source, scene, waiting};
    forget_values(source);

    // A formula waits unless what was gathered later gives its key, or a map that this is in.
    for (int32_t k = 0; k < source->formula_count; k++) {
        const FormulaSetting *formula = &source->formulas[k];
        waiting[k] = true;
        for (int32_t i = formula->before; i < source->setting_count; i++) {
            const Setting *setting = &source->settings[i];
            char name[2 * SCENE_KEY_SIZE];
            bool below = setting->key >= 0 && setting->value.part;
            const char *key = setting->key >= 0 ? source->keys[setting->key].name : setting->group;
            snprintf(name, sizeof name, "%s%s%s", key, below ? "." : "",
                     below ? setting->group : "");
            size_t length = strlen(name);
            if (strncmp(formula->name, name, length) == 0 &&
                (!formula->name[length] || formula->name[length] == '.'))
                waiting[k] = false;
        }
        for (int32_t later = k + 1; later < source->formula_count; later++)
            if (strcmp(source->formulas[later].name, formula->name) == 0) waiting[k] = false;
        left += waiting[k];
    }

    // Each round works out all formulas that name none that is waiting.
    for (; left > 0 && found > 0; left -= found) {
        found = 0;
        memset(known, 0, sizeof known);
        for (int32_t k = 0; k < source->formula_count; k++) {
            const FormulaSetting *formula = &source->formulas[k];
            SceneSetting setting = {formula->name, formula->value.document, formula->value.node};
            char text[SCENE_NUMBER_SIZE];
            Error ignored = {0};
            if (!waiting[k] ||
                !scene_formula_number(&setting, find_number, &numbers, text, &ignored))
                continue;
            if (!yaml_stand_in(setting.document, setting.node, text, err)) return false;
            known[k] = true;
            found++;
        }
        for (int32_t k = 0; k < source->formula_count; k++) waiting[k] = waiting[k] && !known[k];
        if (found > 0 && !store_settings(source, scene, err)) return false;
    }
    if (left == 0) return true;

    // The first formula that waits is wrong, or waits for itself.
    int32_t k = 0;
    while (!waiting[k]) k++;
    const FormulaSetting *formula = &source->formulas[k];
    SceneSetting setting = {formula->name, formula->value.document, formula->value.node};
    char ignored[SCENE_NUMBER_SIZE];
    return scene_formula_number(&setting, scene_number, scene, ignored, err) &&
           yaml_error(setting.document, setting.node, err,
                      "%s: a formula over itself, or over another one that is over this",
                      formula->name);
}

// --- reading ------------------------------------------------------------------------------------

// A file named by `key`, relative to the folder of the scene, becomes relative to the current one.
// An empty name stays.
static bool resolve_file(const SceneSource *source, const Scene *scene, const char *key, char *name,
                         Error *err)
{
    const SceneValue *place = &source->places[scene_key_index(key)];
    const char *path = source->path, *slash = strrchr(path, '/');
    char file[SCENE_TEXT_SIZE];
    bool in_file = place->document && yaml_is_file(place->document);
    if (in_file && !scene_blame(scene, key, open_check_named(name, err), err)) return false;
    memcpy(file, name, sizeof file);
    if (!file[0] || file[0] == '/' || !slash) return true;
    int length = snprintf(name, SCENE_TEXT_SIZE, "%.*s/%s", (int)(slash - path), path, file);
    if (length >= SCENE_TEXT_SIZE)
        return REFUSE(err, "%s: the path %.200s... is longer than 511 bytes", key, name);
    return true;
}

bool scene_source_open(const char *path, bool trusted, SceneSource **out, Error *err)
{
    SceneSource *source = *out = NEW_ARRAY(SceneSource, 1, err);
    if (!source) return false;
    source->trusted = trusted;
    source->keys = scene_keys(&source->key_count);
    if (!yaml_read(path, &source->file, err)) return false;
    if (strlen(path) >= SCENE_TEXT_SIZE)
        return REFUSE(err, "%.80s...: a path of more than 511 bytes", path);
    memcpy(source->path, path, strlen(path) + 1);
    if (!(source->settings = NEW_ARRAY(Setting, SETTINGS_MAX, err)) ||
        !(source->formulas = NEW_ARRAY(FormulaSetting, FORMULAS_MAX, err)))
        return false;

    // The table's defaults are texts, read by the same parser as a scene's values: a default can be
    // typed as it is shown.
    char text[16 * SCENE_KEYS_MAX] = "[";
    size_t used = 1;
    for (int32_t k = 0; k < source->key_count; k++)
        used += (size_t)snprintf(text + used, sizeof text - used, "%s, ",
                                 source->keys[k].standard ? source->keys[k].standard : "~");
    snprintf(text + used - 2, sizeof text - used, "]");
    if (!yaml_parse("defaults", text, 0, &source->defaults, err)) return false;

    SceneValue root = {.document = source->file, .node = YAML_ROOT};
    YamlKind kind = yaml_kind(source->file, YAML_ROOT);
    if (kind == YAML_NOTHING)
        return yaml_error(
            source->file, YAML_ROOT, err,
            "the scene is empty; a scene is a map of keys (`amontons info keys` lists them)");
    if (kind != YAML_MAP)
        return yaml_error(source->file, YAML_ROOT, err,
                          "not a scene: a scene is a map of keys, as in `units: normalised` "
                          "(`amontons info keys` lists them)");
    if (!gather_children(source, "", &root, err)) return false;
    source->file_count = source->setting_count;
    source->file_formulas = source->formula_count;
    return true;
}

// Is called when everything is stored.
static bool finish_reading(SceneSource *source, Scene *scene, Error *err)
{
    char key[SCENE_KEY_SIZE];
    const char *word = NULL;
    SceneProfile profile;   // read again when the contact is known
    bool done;
    if (!resolve_file(source, scene, "material.from", scene->material.from, err)) return false;
    for (int32_t k = 0; k < scene->materials.count; k++)
        if (scene->materials.region[k].has_from &&
            !resolve_file(source, scene, "materials", scene->materials.region[k].from, err))
            return false;
    done = scene_material_files(scene, &word, err);
    if (!done) return scene_blame(scene, word, false, err);
    if (!scene_check(scene, source->places, source->file, err)) return false;
    if (!friction_has_drop(&scene->friction))
        scene->friction.mu_kinetic = scene->friction.mu_static;
    if (!resolve_file(source, scene, "mesh.file", scene->mesh.file, err)) return false;
    if (!resolve_file(source, scene, "friction.file", scene->friction_keys.file, err)) return false;
    if (!resolve_file(source, scene, "contact.profile", scene->contact.profile, err)) return false;
    if (!resolve_file(source, scene, "output.compare", scene->output.compare, err)) return false;
    done = scene_profile_read(scene, &profile, err);
    scene_profile_destroy(&profile);
    if (!scene_blame(scene, "contact.profile", done, err)) return false;
    done = scene_friction_law(scene, scene->friction_keys.formula, scene_nominal_pressure(scene),
                              &scene->friction, &word, err);
    snprintf(key, sizeof key, "friction.%s", done ? "law" : word);
    return scene_blame(scene, key, done, err) &&
           scene_contact_laws(&source->places[scene_key_index("friction.contacts")], scene, err);
}

void scene_source_close(SceneSource *source)
{
    if (!source) return;
    memory_free_all(source->settings, source->formulas);
    yaml_destroy(source->file);
    yaml_destroy(source->defaults);
    memory_free(source);
}

bool scene_source_make(SceneSource *source, const SceneSetting *settings, int32_t count,
                       Scene *scene, Error *err)
{
    *scene = (Scene){.trusted = source->trusted};
    memcpy(scene->path, source->path, sizeof scene->path);
    for (int32_t i = 0; i < count; i++)
        if (!scene_is_formula(settings[i].document, settings[i].node))   // needs the others: below
            TRY(gather_outside(source, &settings[i], err));
    TRY(store_settings(source, scene, err));
    TRY(work_out_formulas(source, scene, err));

    // Formulas of settings, in their order, over the scene that all else and those before make.
    for (int32_t i = 0; i < count; i++) {
        const SceneSetting *setting = &settings[i];
        const bool none[FORMULAS_MAX] = {false};
        Numbers numbers = {source, scene, none};
        char text[SCENE_NUMBER_SIZE];
        int32_t first = source->setting_count;
        if (!scene_is_formula(setting->document, setting->node)) continue;
        TRY(scene_formula_number(setting, find_number, &numbers, text, err));
        TRY(yaml_stand_in(setting->document, setting->node, text, err));
        TRY(gather_outside(source, setting, err));
        TRY(store_from(source, first, scene, err));
        TRY(work_out_formulas(source, scene, err));
    }
    TRY(finish_reading(source, scene, err));
cleanup:
    // The next scene begins with the file alone, and formulas stand for themselves again.
    forget_values(source);
    source->setting_count = source->file_count;
    source->formula_count = source->file_formulas;
    for (int32_t i = 0; i < count; i++)
        yaml_stand_in(settings[i].document, settings[i].node, NULL, &(Error){0});
    return error_is_clean(err);
}

bool scene_read(const char *path, const char *const *overrides, int32_t override_count,
                bool trusted, Scene *scene, Error *err)
{
    typedef char Key[SCENE_KEY_SIZE];
    SceneSource *source = NULL;
    SceneSetting *settings = NEW_ARRAY(SceneSetting, override_count, err);
    YamlDocument **documents = NEW_ARRAY(YamlDocument *, override_count, err);
    Key *keys = NEW_ARRAY(Key, override_count, err);
    TRY(error_is_clean(err));
    TRY(scene_source_open(path, trusted, &source, err));
    for (int32_t i = 0; i < override_count; i++) {
        TRY(scene_override_parse(overrides[i], keys[i], &documents[i], err));
        settings[i] = (SceneSetting){keys[i], documents[i], YAML_ROOT};
    }
    TRY(scene_source_make(source, settings, override_count, scene, err));
cleanup:
    scene_source_close(source);
    for (int32_t i = 0; documents && i < override_count; i++) yaml_destroy(documents[i]);
    memory_free_all(settings, documents, keys);
    return error_is_clean(err);
}

bool scene_blame(const Scene *scene, const char *key, bool done, Error *err)
{
    int32_t index = scene_key_index(key);
    if (done || err->code != ERROR_INPUT) return done;
    if (scene->line[index] > 0)
        error_context(err, "%s:%d: %s", scene->path, scene->line[index], key);
    else
        error_context(err, "%s: %s%s", scene->path, key, scene->given[index] ? ", as set" : "");
    return false;
}
