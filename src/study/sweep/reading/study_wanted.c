// SPDX-License-Identifier: GPL-2.0-or-later
// A quantity that is drawn or ranked by becomes a column of the table if it is none yet.
#include "study/sweep/reading/study_wanted.h"

#include "base/formula.h"
#include "base/text.h"
#include "scene/keys.h"
#include "study/sweep/reading/study_records.h"
#include "study/sweep/reading/wanted_keys.h"

#include <stdio.h>
#include <string.h>

enum { TOP_STANDARD = 10, TOP_MAX = 1000 };

static const struct {
    const char *name, *path;
    bool standard;
} KNOWN_RECORDS[] = {
#define X(name, path, standard, meaning) {name, path, standard},
    STUDY_RECORDS(X)
#undef X
};
enum { KNOWN_RECORD_COUNT = sizeof KNOWN_RECORDS / sizeof KNOWN_RECORDS[0] };

// --- what is recorded ---------------------------------------------------------------------------

typedef struct WantedName {
    const char *name, *what;   // the key it stands under
    YamlNode node;
} WantedName;

static void add_record(Study *study, const char *name, const char *path, const char *given_by,
                       YamlNode node)
{
    StudyRecord *record = &study->records[study->record_count++];
    *record = (StudyRecord){.given_by = given_by, .node = node};
    snprintf(record->name, sizeof record->name, "%s", name);
    snprintf(record->path, sizeof record->path, "%s", path);
}

// The column of `name`, which stands at `node` under the key `what` (static storage): a name of
// STUDY_RECORDS or a path in run.json. What no column holds yet gets one.
static bool find_record(Study *study, const WantedName *wanted, int32_t *column, Error *err)
{
    const char *name = wanted->name, *what = wanted->what, *names[KNOWN_RECORD_COUNT];
    char hint[TEXT_HINT_SIZE];
    YamlNode node = wanted->node;
    const char *path = strchr(name, '.') && strlen(name) < STUDY_NAME_SIZE ? name : NULL;
    for (*column = 0; *column < study->record_count; ++*column)
        if (strcmp(name, study->records[*column].name) == 0) return true;
    for (int32_t k = 0; k < KNOWN_RECORD_COUNT; k++) {
        names[k] = KNOWN_RECORDS[k].name;
        if (strcmp(name, names[k]) == 0) path = KNOWN_RECORDS[k].path;
    }
    if (path && study->record_count == STUDY_RECORDS_MAX)
        return yaml_error(study->file, node, err, "%s: more than %d columns", what,
                          STUDY_RECORDS_MAX);
    if (path) {
        add_record(study, name, path, what, node);
        return true;
    }
    return yaml_error(
        study->file, node, err, "%s: unknown name `%.60s`%s", what, name,
        text_hint(name, names, KNOWN_RECORD_COUNT,
                  "; allowed: a name that `amontons sweep --help` lists, or a path in "
                  "run.json, as in results.mu_max",
                  hint));
}

const char *study_record_path(const char *name)
{
    for (int32_t k = 0; k < KNOWN_RECORD_COUNT; k++)
        if (strcmp(name, KNOWN_RECORDS[k].name) == 0) return KNOWN_RECORDS[k].path;
    return strncmp(name, "results.", 8) == 0 ? name : NULL;
}

static bool read_record(Study *study, YamlNode node, const char *what, int32_t *column, Error *err)
{
    WantedName wanted = {yaml_text(study->file, node), what, node};
    return find_record(study, &wanted, column, err);
}

// A column that every table has, asked for or not.
static bool is_always_there(const char *name)
{
    static const char *const names[] = {"status", "message", "warnings", "run"};
    for (size_t k = 0; k < sizeof names / sizeof *names; k++)
        if (name && strcmp(name, names[k]) == 0) return true;
    return false;
}

// Without `record`, the standard columns of STUDY_RECORDS.
static bool read_records(Study *study, Error *err)
{
    YamlNode list = yaml_look_up(study->file, "record");
    int32_t ignored = 0;
    if (list == YAML_NO_NODE) {
        for (int32_t k = 0; k < KNOWN_RECORD_COUNT; k++)
            if (KNOWN_RECORDS[k].standard)
                add_record(study, KNOWN_RECORDS[k].name, KNOWN_RECORDS[k].path, "", YAML_NO_NODE);
        return true;
    }
    int32_t count = yaml_count(study->file, list);
    if (yaml_kind(study->file, list) != YAML_LIST || count == 0 || count > STUDY_RECORDS_MAX)
        return yaml_refuse(study->file, list, "record", "a list of at most 64 names", err);
    YAML_EACH (item, study->file, list)
        if (!is_always_there(yaml_text(study->file, item)) &&
            !read_record(study, item, "record", &ignored, err))
            return false;
    return error_is_clean(err);
}

// --- rank ---------------------------------------------------------------------------------------

// first, best, or the keys that make a point its own baseline.
static bool read_against(Study *study, const WantedKey *key, Error *err)
{
    static const char *const words[] = {"first", "best"};
    int32_t choice = 0;
    study->rank.baseline = YAML_NO_NODE;
    if (key->node == YAML_NO_NODE || yaml_kind(study->file, key->node) == YAML_SCALAR) {
        if (!wanted_choice(study->file, key, words, 2, &choice, err)) return false;
        study->rank.against = choice ? AGAINST_BEST : AGAINST_FIRST;
        return true;
    }
    if (yaml_kind(study->file, key->node) != YAML_MAP)
        return yaml_refuse(study->file, key->node, "against",
                           "first, best, or a map of varied keys, as in {mesh.set.n: 1}", err);
    study->rank.against = AGAINST_KEYS;
    study->rank.baseline = key->node;
    YAML_EACH (item, study->file, key->node) {
        if (study_is_chosen(study, yaml_key(study->file, item))) continue;
        return yaml_key_error(study->file, item, err,
                              "against: neither `vary` nor `cases` has the key `%.60s`",
                              yaml_key(study->file, item));
    }
    return error_is_clean(err);
}

// A share such as 0.005 or 0.5%. Points that are computed again differ in accuracy.mu: a column.
static bool read_refine(Study *study, const WantedKey *key, Error *err)
{
    if (key->node == YAML_NO_NODE) return true;
    const char *text = yaml_text(study->file, key->node);
    double *share = &study->rank.refine;
    int32_t length = text_number(text, share);
    bool percent = length > 0 && strcmp(text + length, "%") == 0;
    if (percent) *share /= 100;
    if (length == 0 || (text[length] && !percent) || !(*share > 0 && *share < 1))
        return yaml_refuse(study->file, key->node, key->name,
                           "the smallest error bar worth computing, as in 0.5%", err);
    return study_add_column(study, "accuracy.mu", err) >= 0;
}

// {mu_first_pad: highest, scene.mesh.set.pad_height: lowest}
static bool read_also(Study *study, const WantedKey *also, Error *err)
{
    static const char *const orders[] = {"highest", "lowest"};
    StudyRank *rank = &study->rank;
    if (also->node == YAML_NO_NODE) return true;
    if (study->search.node == YAML_NO_NODE || study->search.over != OVER_FRONT)
        return yaml_error(study->file, also->node, err,
                          "also: only of a search with `over: front`");
    if (yaml_kind(study->file, also->node) != YAML_MAP ||
        yaml_count(study->file, also->node) > STUDY_ALSO_MAX)
        return yaml_refuse(study->file, also->node, "also",
                           "at most 3 results, as in {mu_first_pad: highest}", err);
    YAML_EACH (item, study->file, also->node) {
        int32_t order = 0;
        StudyAim *aim = &rank->also[rank->also_count++];
        WantedKey key = {yaml_key(study->file, item), item};
        WantedName name = {key.name, "also", item};
        if (!wanted_choice(study->file, &key, orders, 2, &order, err)) return false;
        if (!find_record(study, &name, &aim->record, err)) return false;
        study->records[aim->record].is_shown = true;
        aim->lowest = order == 1;
    }
    return error_is_clean(err);
}

// The quantity that is ranked by becomes a column of the table if it is none yet.
static bool read_rank(Study *study, Error *err)
{
    static const char *const orders[] = {"highest", "lowest"};
    WantedKey keys[] = {{.name = "by"},      {.name = "order"},  {.name = "top"},
                        {.name = "against"}, {.name = "refine"}, {.name = "also"}};
    StudyRank *rank = &study->rank;
    int32_t order = 0;
    if (yaml_look_up(study->file, "rank") == YAML_NO_NODE) return true;
    if (!wanted_find(study->file, yaml_look_up(study->file, "rank"), "rank", keys, 6, err))
        return false;
    if (keys[0].node == YAML_NO_NODE)
        return yaml_error(study->file, yaml_look_up(study->file, "rank"), err,
                          "rank: `by` must be given, as in {by: mu_M}");
    if (!read_record(study, keys[0].node, "by", &rank->record, err)) return false;
    study->records[rank->record].is_shown = true;
    if (!wanted_choice(study->file, &keys[1], orders, 2, &order, err)) return false;
    if (!read_against(study, &keys[3], err)) return false;
    if (!read_refine(study, &keys[4], err)) return false;
    if (!read_also(study, &keys[5], err)) return false;
    rank->wanted = true;
    rank->lowest = order == 1;
    rank->top = TOP_STANDARD;
    return study_whole(study, &keys[2], TOP_MAX, &rank->top, err);
}

// --- plots --------------------------------------------------------------------------------------

typedef struct QuantityRead {
    Study *study;
    WantedName wanted;   // without a name
    bool is_shown;
    Error *err;
} QuantityRead;

// A key that varies, or what is recorded. As FormulaLookUp: false, with the error set: neither.
static bool find_quantity(const void *context, const char *name, double *ignored)
{
    const QuantityRead *read = context;
    Study *study = read->study;
    WantedName wanted = read->wanted;
    int32_t column = 0;
    const char *part;
    *ignored = 1;
    wanted.name = name;
    if (study_column(study, name) >= 0) return true;
    if (scene_key_index(name) >= 0 || scene_key_above(name, &part) >= 0)
        return yaml_error(study->file, wanted.node, read->err, "%s: `%.60s` does not vary",
                          wanted.what, name);
    if (!find_record(study, &wanted, &column, read->err)) return false;
    study->records[column].is_shown |= read->is_shown;
    return true;
}

static bool check_quantity(Study *study, const StudyPlot *plot, PlotKey key, Error *err)
{
    QuantityRead read = {
        study, {NULL, plot_key_name(key), plot->node[key]}, key != PLOT_CONTOURS, err};
    FormulaNames names = {.look_up = find_quantity, .context = &read, .unknown = "is no column"};
    const char *text = plot->text[key], *equals = strchr(text, '=');
    Formula formula;
    Error found = {0};
    double ignored = 0;
    if (!equals) return !text[0] || find_quantity(&read, text, &ignored);
    if (formula_read(equals + 1, &names, &formula, &found)) return true;
    return error_is_clean(err) &&   // else it was a name
           yaml_error(study->file, plot->node[key], err, "%s: %.200s", plot_key_name(key),
                      found.message);
}

// Each quantity that is drawn becomes a column of the table if it is none yet.
static bool read_plot(Study *study, YamlNode node, Error *err)
{
    if (study->plot_count == STUDY_PLOTS_MAX)
        return yaml_refuse(study->file, node, "plot", "at most 8 plots", err);
    StudyPlot *plot = &study->plots[study->plot_count];
    if (!plot_words_read(study->file, node, plot, err)) return false;
    for (PlotKey key = PLOT_X; key < PLOT_SERIES; key++)
        if (!check_quantity(study, plot, key, err)) return false;
    for (PlotKey key = PLOT_SERIES; key < PLOT_KEYS; key++)
        if (plot->text[key][0] && study_column(study, plot->text[key]) < 0)
            return yaml_refuse(study->file, plot->node[key], plot_key_name(key),
                               "a key that varies", err);
    for (int32_t k = 0; k < study->plot_count; k++)
        if (strcmp(study->plots[k].name, plot->name) == 0)
            return yaml_refuse(study->file, node, "plot",
                               "a `name` that no other plot of the study has", err);
    study->plot_count++;
    return error_is_clean(err);
}

// One plot, or a list of them.
static bool read_plots(Study *study, Error *err)
{
    YamlNode plots = yaml_look_up(study->file, "plot");
    if (plots == YAML_NO_NODE) return true;
    if (yaml_kind(study->file, plots) != YAML_LIST) return read_plot(study, plots, err);
    YAML_EACH (node, study->file, plots)
        if (!read_plot(study, node, err)) return false;
    return error_is_clean(err);
}

bool study_read_wanted(Study *study, Error *err)
{
    return read_records(study, err) && read_rank(study, err) && read_plots(study, err);
}
