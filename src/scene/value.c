// SPDX-License-Identifier: GPL-2.0-or-later
// Each type of key has a function that reads, checks and stores it, and refuses anything else with
// what was found and what is allowed, at its line. Numbers may carry a unit in an SI scene
// (base/units). A value is stored only when it is right: a scene half set keeps its defaults.
#include "scene/value.h"

#include "base/text.h"
#include "base/units.h"
#include "scene/formulas.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

// The key table holds offsets into Scene.
static void *field_of(const SceneKey *key, Scene *scene)
{
    return (char *)scene + key->offset;
}

// "material.young: found `abc`; allowed: a number > 0"; false.
static bool report_wrong(const SceneKey *key, const SceneValue *value, Error *err)
{
    char allowed[300];
    scene_key_allowed(key, allowed, sizeof allowed);
    return yaml_refuse(value->document, value->node, key->name, allowed, err);
}

static bool expect_scalar(const SceneKey *key, const SceneValue *value, Error *err)
{
    return yaml_kind(value->document, value->node) == YAML_SCALAR || report_wrong(key, value, err);
}

typedef bool (*ValueSetter)(const SceneKey *key, const SceneValue *value, Scene *scene, Error *err);

// Hands each item of a list or map (`kind`), at most SCENE_LIST_MAX of them (of numbers
// SCENE_NUMBERS_MAX, of branches SCENE_BRANCHES_MAX), to `set`.
static bool set_items(const SceneKey *key, const SceneValue *value, YamlKind kind, ValueSetter set,
                      Scene *scene, Error *err)
{
    int32_t most = key->type == KEY_NUMBERS    ? (int32_t)SCENE_NUMBERS_MAX
                   : key->type == KEY_BRANCHES ? (int32_t)SCENE_BRANCHES_MAX
                                               : (int32_t)SCENE_LIST_MAX;
    if (yaml_kind(value->document, value->node) != kind ||
        yaml_count(value->document, value->node) > most)
        return report_wrong(key, value, err);
    YAML_EACH (item, value->document, value->node) {
        SceneValue one = {.document = value->document, .node = item};
        if (!set(key, &one, scene, err)) return false;
    }
    return true;
}

// --- numbers ------------------------------------------------------------------------------------

// Applies the unit `suffix` to *number, or says why it does not fit. *is_total: it is one of the
// dimension key->total_unit.
static bool apply_unit(const SceneKey *key, const SceneValue *value, SceneUnits units,
                       const char *suffix, double *number, bool *is_total, Error *err)
{
    const char *text = yaml_text(value->document, value->node);
    *is_total = false;
    if (!*suffix) return true;
    if (strcmp(key->unit, "1") == 0 && strcmp(suffix, "%") == 0) {
        *number /= 100;
        return true;
    }
    if (units == UNITS_NORMALISED)
        return yaml_error(value->document, value->node, err,
                          "%s: found `%.60s`, with a unit; a normalised scene has plain numbers "
                          "(units need `units: si`)",
                          key->name, text);
    if (!*unit_examples(key->unit))
        return yaml_error(value->document, value->node, err,
                          "%s: found `%.60s`; this number has no unit; allowed: %s", key->name,
                          text, scene_range_words(key->range));
    if (unit_to_si(suffix, key->unit, number)) return true;
    *is_total = key->total_unit && unit_to_si(suffix, key->total_unit, number);
    if (*is_total) return true;

    // A unit of another dimension: which are allowed, and by what the number has to be divided.
    bool times = false;
    const char *by = unit_quotient(suffix, key->unit, &times);
    const char *article = by && strchr("aeiou", *by) ? "an" : "a";
    char advice[240] = "";
    if (by)
        snprintf(advice, sizeof advice, "; %s it by %s %s%s%s%s", times ? "multiply" : "divide",
                 article, by, key->hint ? " (" : "", key->hint ? key->hint : "",
                 key->hint ? ")" : "");
    return yaml_error(value->document, value->node, err,
                      "%s: found `%.60s`; `%.30s` is no unit of %s; allowed: %s%s%s%s", key->name,
                      text, suffix, key->unit, unit_examples(key->unit),
                      key->total_unit ? ", " : "",
                      key->total_unit ? unit_examples(key->total_unit) : "", advice);
}

// A formula that has no value yet: what holds it is read again when scene/scene_read has worked it
// out. Until then its number is 0, which is not checked.
static bool is_waiting(const SceneValue *value)
{
    return scene_is_formula(value->document, value->node);
}

// Range is the caller's to check. ERROR_INPUT for what is not a finite decimal number.
static bool read_number(const SceneKey *key, const SceneValue *value, SceneUnits units,
                        double *number, bool *is_total, Error *err)
{
    static const char minus[] = "\xE2\x88\x92", dash[] = "\xE2\x80\x93";   // U+2212, U+2013
    const YamlDocument *document = value->document;
    if (!expect_scalar(key, value, err)) return false;

    // "0,003", or a minus sign that is none of ASCII, as word processors and spreadsheets have it.
    const char *text = yaml_text(document, value->node), *comma = strchr(text, ',');
    if (comma > text && isdigit((unsigned char)comma[-1]) && isdigit((unsigned char)comma[1]))
        return yaml_error(document, value->node, err,
                          "%s: found `%.60s`, with a comma: decimals follow a point, as in 0.003",
                          key->name, text);
    if (strstr(text, minus) || strstr(text, dash))
        return yaml_error(document, value->node, err,
                          "%s: found `%.60s`, with a minus sign or dash of a word processor: the "
                          "hyphen of the keyboard, -, is needed",
                          key->name, text);

    // "10 um/s" is 10 and "um/s".
    int32_t length = text_number(text, number);
    if (length == 0) return report_wrong(key, value, err);
    const char *suffix = text + length + strspn(text + length, " ");
    if (!apply_unit(key, value, units, suffix, number, is_total, err)) return false;
    if (!isfinite(*number)) return report_wrong(key, value, err);
    if (!scene_size_holds(*number))
        return yaml_error(document, value->node, err,
                          "%s: found `%.60s`; allowed: 0, and numbers of a size from %g to %g",
                          key->name, text, SCENE_SMALLEST, SCENE_LARGEST);
    return true;
}

static bool read_in_range(const SceneKey *key, const SceneValue *value, SceneUnits units,
                          double *number, bool *is_total, Error *err)
{
    *number = 0;
    *is_total = false;
    if (is_waiting(value)) return true;
    if (!read_number(key, value, units, number, is_total, err)) return false;
    return scene_range_holds(key->range, *number) || report_wrong(key, value, err);
}

static bool add_number(const SceneKey *key, const SceneValue *value, Scene *scene, Error *err)
{
    SceneNumbers *numbers = field_of(key, scene);
    double number = 0;
    bool is_total = false;
    if (!read_in_range(key, value, scene->units, &number, &is_total, err)) return false;
    numbers->value[numbers->count++] = number;
    return true;
}

// --- branches -----------------------------------------------------------------------------------

enum { TIME, SHEAR, BULK, WORDS };

// The number that stands at a word of a branch, `word` its place in {time, shear, bulk}; WORDS: it
// is none of these.
static bool read_branch_word(const SceneKey *key, const char *name, const SceneValue *value,
                             const Scene *scene, double *number, int32_t *word, Error *err)
{
    static const SceneKey words[] = {
        {.name = "time", .type = KEY_NUMBER, .unit = "time", .range = RANGE_POSITIVE},
        {.name = "shear", .type = KEY_NUMBER, .unit = "stress", .range = RANGE_NOT_NEGATIVE},
        {.name = "bulk", .type = KEY_NUMBER, .unit = "stress", .range = RANGE_NOT_NEGATIVE}};
    char path[100];
    int32_t k = 0;
    while (k < WORDS && strcmp(words[k].name, name) != 0) k++;
    if (k == WORDS)
        return yaml_key_error(value->document, value->node, err,
                              "%s: unknown key `%.60s`; allowed: time, shear, bulk", key->name,
                              name);
    *word = k;
    SceneKey own = words[k];
    snprintf(path, sizeof path, "%s.%s", key->name, name);
    own.name = path;
    return read_in_range(&own, value, scene->units, &number[k], &(bool){false}, err);
}

// One map {time, shear, bulk}.
static bool add_branch(const SceneKey *key, const SceneValue *value, Scene *scene, Error *err)
{
    static const char allowed[] = "a map {time: TIME, shear: STRESS, bulk: STRESS}";
    const YamlDocument *document = value->document;
    SceneRelaxation *relaxation = field_of(key, scene);
    double number[WORDS] = {0};
    bool given[WORDS] = {0}, formulas = false;
    if (yaml_kind(document, value->node) != YAML_MAP)
        return yaml_refuse(document, value->node, key->name, allowed, err);
    YAML_EACH (node, document, value->node) {
        SceneValue one = {.document = document, .node = node};
        int32_t k = WORDS;
        if (!read_branch_word(key, yaml_key(document, node), &one, scene, number, &k, err))
            return false;
        given[k] = true;
        formulas = formulas || is_waiting(&one);
    }
    if (!given[TIME])
        return yaml_error(document, value->node, err, "%s: a branch needs its `time`; allowed: %s",
                          key->name, allowed);
    if (!formulas && !(number[SHEAR] + number[BULK] > 0))
        return yaml_error(document, value->node, err,
                          "%s: a branch needs `shear` or `bulk` above 0", key->name);
    for (int32_t i = 0; i < relaxation->count; i++)
        if (number[TIME] > 0 && relaxation->branch[i].time == number[TIME])
            return yaml_error(document, value->node, err,
                              "%s: the time %g stands twice; add up the moduli", key->name,
                              number[TIME]);
    relaxation->branch[relaxation->count++] =
        (SceneBranch){number[TIME], number[SHEAR], number[BULK]};
    return true;
}

// One number of a branch of the list, value->part "0.shear".
static bool set_branch_part(const SceneKey *key, const SceneValue *value, Scene *scene, Error *err)
{
    SceneRelaxation *relaxation = field_of(key, scene);
    char *end;
    long k = strtol(value->part, &end, 10);
    int32_t word = WORDS;
    double number[WORDS];
    if (end == value->part || *end != '.' || k < 0 || k >= relaxation->count)
        return yaml_key_error(value->document, value->node, err,
                              "%s.%.60s: there is no such branch; of %d the first is %s.0, and "
                              "its numbers are %s.0.time, .shear and .bulk",
                              key->name, value->part, relaxation->count, key->name, key->name);
    SceneBranch *branch = &relaxation->branch[k];
    if (!read_branch_word(key, end + 1, value, scene, number, &word, err)) return false;
    *(word == TIME ? &branch->time : word == SHEAR ? &branch->shear : &branch->bulk) = number[word];
    return true;
}

// --- words --------------------------------------------------------------------------------------

// true and false as YAML 1.2's core schema has them; YAML 1.1's yes, no, on and off are refused.
static bool read_flag(const char *text, bool *flag)
{
    static const char *const words[2][3] = {{"false", "False", "FALSE"}, {"true", "True", "TRUE"}};
    for (int32_t k = 0; k < 6; k++) {
        *flag = k >= 3;
        if (strcmp(text, words[*flag][k % 3]) == 0) return true;
    }
    return false;
}

// size: of `out`, which is filled with zeros first. A name (GROUP_NAME_SIZE) must not be empty; no
// text may have line ends or tabs.
static bool copy_text(const SceneKey *key, const SceneValue *value, size_t size, char *out,
                      Error *err)
{
    if (!expect_scalar(key, value, err)) return false;
    const char *text = yaml_text(value->document, value->node);
    bool empty_name = size == GROUP_NAME_SIZE && !*text;
    if (empty_name || strlen(text) >= size || strpbrk(text, "\n\r\t"))
        return report_wrong(key, value, err);
    memcpy(memset(out, 0, size), text, strlen(text) + 1);
    return true;
}

// -1: not among them. Programs that read YAML 1.1 write `on` and `off` back as true and false.
static int32_t find_choice(const SceneKey *key, const char *text)
{
    bool flag;
    for (int32_t k = 0; key->choices[k]; k++)
        if (strcmp(key->choices[k], text) == 0) return k;
    for (int32_t k = 0; read_flag(text, &flag) && key->choices[k]; k++)
        if (strcmp(key->choices[k], flag ? "on" : "off") == 0) return k;
    return -1;
}

// A word that is no choice: which one it probably means. A yes or a no never means the other one,
// however alike the words are. Always false.
static bool report_choice(const SceneKey *key, const SceneValue *value, Error *err)
{
    static const char *const words[][2] = {{"yes", "on"},  {"y", "on"},     {"on", "on"},
                                           {"true", "on"}, {"no", "off"},   {"n", "off"},
                                           {"off", "off"}, {"false", "off"}};
    const char *text = yaml_text(value->document, value->node), *meant = NULL;
    int32_t count = 0;
    bool switches = false;
    for (; key->choices[count]; count++)
        switches = switches || strcmp(key->choices[count], "off") == 0;
    for (size_t k = 0; switches && k < sizeof words / sizeof *words; k++)
        if (strcasecmp(text, words[k][0]) == 0) meant = words[k][1];
    int32_t nearest = meant ? find_choice(key, meant) : text_nearest(text, key->choices, count);
    char allowed[300];
    scene_key_allowed(key, allowed, sizeof allowed);
    if (nearest < 0) return report_wrong(key, value, err);
    return yaml_error(value->document, value->node, err,
                      "%s: found `%.60s`, did you mean `%s`? Allowed: %s", key->name, text,
                      key->choices[nearest], allowed);
}

static bool add_name(const SceneKey *key, const SceneValue *value, Scene *scene, Error *err)
{
    SceneNames *names = field_of(key, scene);
    char name[GROUP_NAME_SIZE];
    if (!copy_text(key, value, GROUP_NAME_SIZE, name, err)) return false;
    if (key->choices && find_choice(key, name) < 0) return report_choice(key, value, err);
    for (int32_t i = 0; i < names->count; i++)
        if (strcmp(names->name[i], name) == 0)
            return yaml_error(value->document, value->node, err,
                              "%s: `%s` stands twice in the list", key->name, name);
    memcpy(names->name[names->count++], name, sizeof name);
    return true;
}

// --- by the type of the key ---------------------------------------------------------------------

// The parameter that the value's own key names, or the rest of the path of a --set.
static bool set_parameter(const SceneKey *key, const SceneValue *value, Scene *scene, Error *err)
{
    MeshParameter made = {0};
    const char *name = value->part ? value->part : yaml_key(value->document, value->node);
    const char *text = yaml_text(value->document, value->node);
    MeshParameter *parameter = NULL;
    for (int32_t i = 0; i < scene->mesh.parameter_count && !parameter; i++)
        if (strcmp(scene->mesh.parameters[i].name, name) == 0)
            parameter = &scene->mesh.parameters[i];
    if (is_waiting(value)) return true;
    bool full = !parameter && scene->mesh.parameter_count == SCENE_LIST_MAX;
    if (full || !*name || strlen(name) >= GROUP_NAME_SIZE)
        return yaml_key_error(value->document, value->node, err,
                              "%s: at most 32 parameters, with names of 1 to 63 bytes", key->name);
    if (!expect_scalar(key, value, err)) return false;
    double ignored = 0;
    bool is_total = false;
    bool number = !yaml_is_quoted(value->document, value->node) && text_number(text, &ignored);
    bool read = number ? read_number(key, value, scene->units, &made.value, &is_total, err)
                       : copy_text(key, value, GROUP_NAME_SIZE, made.text, err);
    if (!read) return false;
    memcpy(made.name, name, strlen(name) + 1);
    if (!parameter) parameter = &scene->mesh.parameters[scene->mesh.parameter_count++];
    *parameter = made;
    return true;
}

void scene_value_clear(const SceneKey *key, Scene *scene)
{
    size_t size = key->type == KEY_NUMBER     ? sizeof(double)
                  : key->type == KEY_NUMBERS  ? sizeof(SceneNumbers)
                  : key->type == KEY_CHOICE   ? sizeof(int32_t)
                  : key->type == KEY_FLAG     ? sizeof(bool)
                  : key->type == KEY_BRANCHES ? sizeof(SceneRelaxation)
                  : key->type == KEY_ITEMS    ? sizeof(int32_t)   // how many there are
                                              : SCENE_TEXT_SIZE;
    memset(field_of(key, scene), 0, size);
    if (key->total_unit) *(bool *)((char *)scene + key->is_total) = false;
}

bool scene_value_set(const SceneKey *key, const SceneValue *value, Scene *scene, Error *err)
{
    YamlKind kind = yaml_kind(value->document, value->node);
    const char *text = yaml_text(value->document, value->node);   // of a scalar
    void *field = field_of(key, scene);
    switch (key->type) {
    case KEY_NUMBER: {
        double number = 0;
        bool is_total = false;
        if (is_waiting(value)) return true;   // the default stays
        if (!read_in_range(key, value, scene->units, &number, &is_total, err)) return false;
        memcpy(field, &number, sizeof number);
        if (key->total_unit) *(bool *)((char *)scene + key->is_total) = is_total;
        return true;
    }
    case KEY_FLAG: {
        bool flag;
        if (!read_flag(text, &flag)) return report_wrong(key, value, err);
        memcpy(field, &flag, sizeof flag);
        return true;
    }
    case KEY_TEXT:
        return copy_text(key, value, SCENE_TEXT_SIZE, field, err);
    case KEY_NAME:
        return copy_text(key, value, GROUP_NAME_SIZE, field, err);
    case KEY_CHOICE: {
        if (!expect_scalar(key, value, err)) return false;
        int32_t choice = find_choice(key, text);
        if (choice < 0) return report_choice(key, value, err);
        memcpy(field, &choice, sizeof choice);
        return true;
    }
    case KEY_NUMBERS:
        scene_value_clear(key, scene);
        return set_items(key, value, YAML_LIST, add_number, scene, err);
    case KEY_NAMES:   // one name, or a list of them; nothing is an empty list
        *(SceneNames *)field = (SceneNames){0};
        if (kind == YAML_NOTHING) return true;
        if (kind == YAML_SCALAR) return add_name(key, value, scene, err);
        return set_items(key, value, YAML_LIST, add_name, scene, err);
    case KEY_PARAMETERS:
        if (value->part) return set_parameter(key, value, scene, err);
        scene->mesh.parameter_count = 0;
        if (kind == YAML_NOTHING) return true;
        return set_items(key, value, YAML_MAP, set_parameter, scene, err);
    case KEY_ITEMS:   // scene/items
        return true;
    case KEY_BRANCHES:
        if (value->part) return set_branch_part(key, value, scene, err);
        scene_value_clear(key, scene);
        if (kind == YAML_NOTHING) return true;
        return set_items(key, value, YAML_LIST, add_branch, scene, err);
    case KEY_FIELDS: {
        // `none`, or a map whose keys follow as settings of their own; these were given their
        // defaults before.
        bool is_film = kind != YAML_MAP && strcmp(text, "film") == 0;
        if (kind != YAML_MAP && !is_film && strcmp(text, "none") != 0)
            return report_wrong(key, value, err);
        scene->output.fields = kind == YAML_MAP || is_film;
        scene->output.fields_film = is_film;
        scene->output.fields_every_U = scene->output.fields_every_t = 0;
        scene->output.fields_every_step = scene->output.fields_at_events = false;
        return true;
    }
    }
    return true;
}
