// SPDX-License-Identifier: GPL-2.0-or-later
// Reads a study's file: what it changes in its base scene (`set`, `cases`, `vary`, --set) and what
// it searches (`search`, `where`, `best` or `fit`). Lists are bounded (study.h), so that a typing
// error ends in a message and not in a week of runs. study_wanted reads what is wanted of it.
#include "study/sweep/reading/study.h"

#include "base/memory.h"
#include "base/text.h"
#include "io/files/folder.h"
#include "io/files/open_file.h"
#include "scene/formulas.h"
#include "scene/keys.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { DESIGNS_FEWEST = 20, DESIGNS_A_KEY = 10 };   // without `best: {designs: ...}`

static const char AXIS_ALLOWED[] = "a list of values, {log: [from, to], points: n} or "
                                   "{linear: [from, to], points: n}";
static const char KEY_ALLOWED[] = "{linear: [least, most]}, {log: [least, most]} or "
                                  "{whole: [least, most]}";

// --- keys of the scene ------------------------------------------------------------------------

// The keys that a value given under `key` sets: itself, or those of the map below it.
static bool add_columns(Study *study, const char *key, const YamlDocument *document, YamlNode node,
                        bool varied, Error *err)
{
    bool opens = yaml_kind(document, node) == YAML_MAP;
    bool is_map_of_keys = strcmp(key, "mesh.set") == 0 || strcmp(key, "output.fields") == 0 ||
                          strcmp(key, "materials") == 0 || strncmp(key, "materials.", 10) == 0 ||
                          (scene_key_is_group(key) && scene_key_index(key) < 0);
    if (!opens || !is_map_of_keys) {
        int32_t column = study_add_column(study, key, err);
        if (column < 0) return false;
        study->chosen[column] = true;
        study->varied[column] = study->varied[column] || varied;
        return true;
    }
    YAML_EACH (item, document, node) {
        char path[STUDY_NAME_SIZE];
        snprintf(path, sizeof path, "%.40s.%.50s", key, yaml_key(document, item));
        if (!add_columns(study, path, document, item, varied, err)) return false;
    }
    return error_is_clean(err);
}

// Refuses an item of `what` that gives a key that varies. A formula of `cases` over that key itself
// (= 2 * load.pressure) takes what varies, and is no second value.
static bool check_given(const Study *study, const char *what, YamlNode item, bool takes, Error *err)
{
    const char *found =
        study_find_given(study, study->varied, yaml_key(study->file, item), study->file, item);
    if (!found || (takes && scene_is_formula(study->file, item) &&
                   strstr(yaml_text(study->file, item), found)))
        return true;
    return yaml_key_error(study->file, item, err, "%s: given by `%s` and again by `vary`", found,
                          what);
}

// A key as one would type it after --set: one of the scene's, a map of them, or mesh.set.NAME.
// Whether it can be set is known here; whether its value is right when a scene is made.
static bool check_key(const YamlDocument *document, YamlNode item, Error *err)
{
    const char *key = yaml_key(document, item), *part;
    int32_t above = scene_key_above(key, &part), count;
    bool is_state = above >= 0 && scene_keys(&count)[above].items == &scene_state_items;
    bool is_known = scene_key_index(key) >= 0 || scene_key_is_group(key) ||
                    (above >= 0 && !is_state);   // numbers of states are not read back
    if (strlen(key) >= STUDY_NAME_SIZE)
        yaml_key_error(document, item, err, "a key of more than %d bytes", STUDY_NAME_SIZE - 1);
    else if (!is_known)
        scene_key_refuse(document, item, key, err);
    return error_is_clean(err);
}

// --- cases and what varies ----------------------------------------------------------------------

// Every key of any case is a column; a case without it has the base scene's value there.
static bool read_cases(Study *study, const YamlDocument *document, YamlNode cases, Error *err)
{
    if (yaml_kind(document, cases) != YAML_LIST || yaml_count(document, cases) == 0)
        return yaml_refuse(document, cases, "cases", "a list of maps of the scene's keys", err);
    YAML_EACH (one, document, cases) {
        if (yaml_kind(document, one) != YAML_MAP)
            return yaml_refuse(document, one, "cases", "a map of the scene's keys", err);
        int32_t count = study->case_list ? study->case_count
                                         : 0;   // without cases there is one point
        if (!memory_grow(&study->case_list, count, &study->case_room, sizeof *study->case_list,
                         err))
            return false;
        study->case_list[count] = (StudyCase){document, one};
        study->case_count = count + 1;
        YAML_EACH (item, document, one) {
            if (!check_key(document, item, err)) return false;
            if (!add_columns(study, yaml_key(document, item), document, item, false, err))
                return false;
        }
        if (!error_is_clean(err)) return false;
    }
    return error_is_clean(err);
}

// {log: [from, to], points: n} or {linear: [from, to], points: n}. Ends are met exactly; what lies
// between is rounded to 6 digits, so that it can be quoted. The values are written as a YAML list
// and parsed into a document of the study (made), so that they are read as those in the file are;
// errors in them name the range's place.
static bool read_range(Study *study, YamlNode node, StudyAxis *axis, Error *err)
{
    enum { NUMBER_SIZE = 32 + STUDY_UNIT_SIZE };
    WantedKey keys[] = {{.name = "log"}, {.name = "linear"}, {.name = "points"}};
    double bounds[2] = {0, 0};
    int32_t points = 0;
    int64_t used = 1;
    char *text = NULL, name[SCENE_TEXT_SIZE + 80], unit[STUDY_UNIT_SIZE];
    if (!wanted_find(study->file, node, axis->key, keys, 3, err)) return false;
    bool is_log = keys[0].node != YAML_NO_NODE;
    YamlNode ends = keys[is_log ? 0 : 1].node;
    if (yaml_count(study->file, node) != 2 || ends == YAML_NO_NODE || keys[2].node == YAML_NO_NODE)
        return yaml_refuse(study->file, node, axis->key, AXIS_ALLOWED, err);
    if (!study_pair(study, ends, axis->key, bounds, unit))
        return yaml_refuse(study->file, ends, axis->key,
                           "two numbers, [from, to], both with a unit of the key's or both without",
                           err);
    if (is_log && !(bounds[0] > 0 && bounds[1] > 0))
        return yaml_refuse(study->file, ends, axis->key, "two numbers > 0 in a range of logarithms",
                           err);
    if (!study_whole(study, &keys[2], STUDY_RANGE_MAX, &points, err)) return false;

    double from = bounds[0], to = bounds[1];
    TRY((text = NEW_ARRAY(char, (int64_t)points *NUMBER_SIZE + 8, err)));
    text[0] = '[';
    for (int32_t k = 0; k < points; k++) {
        double part = points > 1 ? (double)k / (points - 1) : 0;
        double value = is_log ? from * pow(to / from, part) : from + (to - from) * part;
        char number[NUMBER_TEXT_SIZE];
        snprintf(number, sizeof number, "%.6g", value);
        if (k == 0 || k == points - 1) text_shortest(k == 0 ? from : to, 6, number);
        used += snprintf(text + used, NUMBER_SIZE, "%s%s%s", k ? ", " : "", number, unit);
    }
    text[used] = ']';

    snprintf(name, sizeof name, "%s:%d:%d, values of the range", study->path,
             yaml_line(study->file, node), yaml_column(study->file, node));
    TRY(yaml_parse(name, text, 0, &study->made[study->made_count], err));
    axis->document = study->made[study->made_count++];
    axis->list = YAML_ROOT;
cleanup:
    memory_free(text);
    return error_is_clean(err);
}

// A key of `vary`: a list of values, or those of a range, made into a document of their own.
static bool read_axis(Study *study, YamlNode item, Error *err)
{
    StudyAxis *axis = &study->axes[study->axis_count];
    if (!check_key(study->file, item, err)) return false;
    snprintf(axis->key, sizeof axis->key, "%s", yaml_key(study->file, item));
    axis->document = study->file;
    axis->list = item;
    YamlKind kind = yaml_kind(study->file, item);
    if (kind == YAML_MAP && !read_range(study, item, axis, err)) return false;
    axis->count = yaml_count(axis->document, axis->list);
    if ((kind != YAML_MAP && kind != YAML_LIST) || axis->count == 0)
        return yaml_refuse(study->file, item, axis->key, AXIS_ALLOWED, err);
    if (!(axis->values = NEW_ARRAY(YamlNode, axis->count, err))) return false;
    study->axis_count++;
    int32_t filled = 0;
    YAML_EACH (value, axis->document, axis->list) axis->values[filled++] = value;
    YAML_EACH (value, axis->document, axis->list) {
        const char *found =
            study_find_given(study, study->varied, axis->key, axis->document, value);
        if (found) return yaml_key_error(study->file, item, err, "%s: varied twice", found);
    }
    YAML_EACH (value, axis->document, axis->list)
        if (!add_columns(study, axis->key, axis->document, value, true, err)) return false;
    return error_is_clean(err);
}

// Counted in 64 bits: a product of lists overflows 32 sooner than it looks.
static bool count_points(Study *study, Error *err)
{
    int64_t count = study->case_count;
    for (int32_t k = 0; k < study->axis_count && count <= STUDY_POINTS_MAX; k++)
        count *= study->axes[k].count;
    if (count > STUDY_POINTS_MAX)
        return REFUSE(err, "%s: more than %d points", study->path, STUDY_POINTS_MAX);
    study->point_count = (int32_t)count;
    return true;
}

// Fills columns, cases, axes, overrides, `set` and point_count. `cases` and `vary` decide which
// keys are columns; --set refuses those, and is read after them; `set` comes after --set, which may
// replace a formula.
static bool read_changes(Study *study, const char *const *overrides, int32_t override_count,
                         Error *err)
{
    const YamlDocument *file = study->file;
    if (override_count > STUDY_SETTINGS_MAX - STUDY_AXES_MAX - 1)
        return REFUSE(err, "more than %d settings by --set",
                      STUDY_SETTINGS_MAX - STUDY_AXES_MAX - 1);
    study->case_count = 1;
    study->cases = yaml_look_up(file, "cases");
    if (study->cases != YAML_NO_NODE && !read_cases(study, file, study->cases, err)) return false;

    YamlNode vary = yaml_look_up(file, "vary");
    if (vary != YAML_NO_NODE) {
        if (yaml_kind(file, vary) != YAML_MAP || yaml_count(file, vary) > STUDY_AXES_MAX)
            return yaml_refuse(file, vary, "vary", "a map of at most 16 keys of the scene", err);
        YAML_EACH (item, file, vary)
            if (!read_axis(study, item, err)) return false;
        if (!error_is_clean(err)) return false;
    }

    // --set: a key that varies is refused, rather than silently losing to `vary`.
    for (int32_t k = 0; k < override_count; k++) {
        char *key = study->override_keys[k];
        YamlDocument **document = &study->made[study->made_count];
        if (!scene_override_parse(overrides[k], key, document, err)) return false;
        study->made_count++;
        const char *found = study_find_given(study, study->chosen, key, *document, YAML_ROOT);
        if (found) return REFUSE(err, "--set %s: %s varies %s", key, study->path, found);
        study->overrides[study->override_count++] =
            (SceneSetting){.key = key, .document = *document, .node = YAML_ROOT};
    }

    // `set`: formulas make columns, since their values differ from point to point; plain values do
    // not.
    study->set = yaml_look_up(file, "set");
    if (study->set != YAML_NO_NODE) {
        if (yaml_kind(file, study->set) != YAML_MAP)
            return yaml_refuse(file, study->set, "set", "a map of the scene's keys", err);
        YAML_EACH (item, file, study->set) {
            if (!check_key(file, item, err)) return false;
            if (!check_given(study, "set", item, false, err)) return false;
            if (scene_is_formula(file, item) &&
                study_add_column(study, yaml_key(file, item), err) < 0)
                return false;
        }
        if (!error_is_clean(err)) return false;
    }

    // A key has one value at a point, from one place. Cases may replace what `set` gives: it is
    // what the other cases have.
    if (study->cases != YAML_NO_NODE) {
        YAML_EACH (one, file, study->cases)
            YAML_EACH (item, file, one)
                if (!check_given(study, "cases", item, true, err)) return false;
        if (!error_is_clean(err)) return false;
    }
    return count_points(study, err);
}

bool study_add_designs(Study *study, const char *text, Error *err)
{
    int32_t count = study->design_count;
    if (!memory_grow(&study->designs, count, &study->design_room, sizeof *study->designs, err))
        return false;
    StudyDesigns *one = &study->designs[count];
    *one = (StudyDesigns){.text = memory_text(text, err)};
    if (!one->text) return false;
    study->design_count++;   // half of it is freed as well
    return yaml_parse("designs of the search", text, 0, &one->file, err) &&
           read_cases(study, one->file, YAML_ROOT, err) && count_points(study, err);
}

// --- what is searched ---------------------------------------------------------------------------

// {log: [0.01, 0.2]}
static bool read_search_key(Study *study, YamlNode item, Error *err)
{
    static const char *const scales[] = {"linear", "log", "whole"};
    StudySearch *search = &study->search;
    SearchKey *key = &search->keys[search->key_count];
    YamlNode range = yaml_first(study->file, item);
    if (!check_key(study->file, item, err)) return false;
    snprintf(key->key, sizeof key->key, "%s", yaml_key(study->file, item));
    int32_t scale = 0;
    bool good = yaml_kind(study->file, item) == YAML_MAP && yaml_count(study->file, item) == 1;
    while (good && scale < 3 && strcmp(yaml_key(study->file, range), scales[scale]) != 0) scale++;
    if (!good || scale == 3) return yaml_refuse(study->file, item, key->key, KEY_ALLOWED, err);
    double ends[2] = {0, 0};
    key->scale = (SearchScale)scale;
    good = study_pair(study, range, key->key, ends, key->unit);
    key->least = ends[0], key->most = ends[1];
    if (!good || !(key->least < key->most) || (key->scale == SEARCH_LOG && key->least <= 0))
        return yaml_refuse(study->file, range, key->key,
                           "two numbers, the smaller one first (of log: above 0), both with a unit "
                           "of the key's or both without",
                           err);
    if (key->scale == SEARCH_WHOLE &&
        (key->least != floor(key->least) || key->most != floor(key->most)))
        return yaml_refuse(study->file, range, key->key, "two whole numbers", err);
    search->key_count++;
    int32_t column = study_column(study, key->key);
    if (column >= 0 && study->chosen[column])
        return yaml_key_error(study->file, item, err, "%s: searched, and given by `vary` as well",
                              key->key);
    return study_add_column(study, key->key, err) >= 0;
}

// Reads `search`, `where`, and the aim: `best`, or `fit`, which has `measured` and `sure` in place
// of `over`. A study has one aim.
static bool read_search(Study *study, Error *err)
{
    static const char *const rest[] = {"where", "best", "fit"};
    static const char *const over[] = {"worst", "mean", "deviation", "front"};
    static const char *const shares[] = {"95%", "68%", "90%", "99%"};
    static const double sure[] = {0.95, 0.68, 0.90, 0.99};
    static const double quantiles[] = {3.841, 0.989, 2.706, 6.635};
    const YamlDocument *file = study->file;
    StudySearch *search = &study->search;
    search->node = yaml_look_up(file, "search");
    for (int32_t k = 0; search->node == YAML_NO_NODE && k < 3; k++) {
        YamlNode node = yaml_look_up(file, rest[k]);
        if (node != YAML_NO_NODE)
            return yaml_key_error(file, node, err, "%s: only of a study with `search`", rest[k]);
    }
    if (search->node == YAML_NO_NODE) return true;

    int32_t count = yaml_count(file, search->node);
    if (yaml_kind(file, search->node) != YAML_MAP || count < 1 || count > STUDY_SEARCH_MAX)
        return yaml_refuse(file, search->node, "search", "a map of 1 to 12 keys of the scene", err);
    if (study->cases != YAML_NO_NODE)
        return yaml_error(file, study->cases, err,
                          "cases: a study with `search` makes its own; conditions go under `vary`");
    YAML_EACH (item, file, search->node)
        if (!read_search_key(study, item, err)) return false;

    // The limits: [{value: = mesh.set.n * mesh.set.pad_height, least: 0.1, most: 0.6}]
    YamlNode where = yaml_look_up(file, "where");
    if (where != YAML_NO_NODE) {
        if (yaml_kind(file, where) != YAML_LIST || yaml_count(file, where) > STUDY_LIMITS_MAX)
            return yaml_refuse(file, where, "where", "a list of at most 16 limits", err);
        YAML_EACH (item, file, where) {
            WantedKey keys[] = {{.name = "value"}, {.name = "least"}, {.name = "most"}};
            SearchLimit *limit = &search->limits[search->limit_count++];
            *limit = (SearchLimit){YAML_NO_NODE, -INFINITY, INFINITY};
            if (!wanted_find(file, item, "where", keys, 3, err)) return false;
            limit->formula = keys[0].node;
            if (limit->formula == YAML_NO_NODE || !scene_is_formula(file, limit->formula))
                return yaml_refuse(file, item, "where",
                                   "{value: = a formula, least: number, most: number}", err);
            for (int32_t k = 1; k < 3; k++)
                if (keys[k].node != YAML_NO_NODE &&
                    !study_plain_number(study, keys[k].node, k == 1 ? &limit->least : &limit->most))
                    return yaml_refuse(file, keys[k].node, keys[k].name, "a number", err);
            if (!(limit->least <= limit->most) || (isinf(limit->least) && isinf(limit->most)))
                return yaml_refuse(file, item, "where",
                                   "`least`, `most`, or both, `most` not below", err);
        }
    }

    // The aim.
    YamlNode fit = yaml_look_up(file, "fit"), best = yaml_look_up(file, "best");
    search->fits = fit != YAML_NO_NODE;
    if (search->fits && best != YAML_NO_NODE)
        return yaml_key_error(file, best, err, "best: not in a study with `fit`");
    if (search->fits && study->axis_count > 0)
        return yaml_error(
            file, yaml_look_up(file, "vary"), err,
            "vary: in a study with `fit` conditions are columns of what was measured");

    WantedKey keys[] = {{.name = "designs"}, {.name = "seed"}, {.name = "over"}, {.name = "sure"}};
    YamlNode goal = search->fits ? fit : best;
    int32_t choice = 0, seed = 1;
    search->designs = DESIGNS_FEWEST + DESIGNS_A_KEY * search->key_count;
    if (search->fits) keys[2].name = "measured";
    if (goal != YAML_NO_NODE) {
        if (!wanted_find(file, goal, search->fits ? "fit" : "best", keys, search->fits ? 4 : 3,
                         err))
            return false;
        if (!study_whole(study, &keys[0], STUDY_DESIGNS_MAX, &search->designs, err)) return false;
        if (!study_whole(study, &keys[1], INT32_MAX, &seed, err)) return false;
        if (!search->fits && !wanted_choice(file, &keys[2], over, 4, &choice, err)) return false;
    }
    search->over = (SearchOver)choice;
    search->seed = (uint32_t)seed;
    if (!search->fits) return true;
    search->measured = keys[2].node;
    if (!wanted_choice(file, &keys[3], shares, 4, &choice, err)) return false;
    search->sure = sure[choice];
    search->quantile = quantiles[choice];
    return search->measured != YAML_NO_NODE ||
           yaml_error(file, goal, err,
                      "fit: `measured` must be given: a table, as in {measured: measured.csv}");
}

// --- the whole ----------------------------------------------------------------------------------

// text stays as it is where the key is missing.
static bool read_text(const Study *study, const char *key, char text[SCENE_TEXT_SIZE], Error *err)
{
    YamlNode node = yaml_look_up(study->file, key);
    if (node == YAML_NO_NODE) return true;
    const char *value = yaml_text(study->file, node);
    bool fits = yaml_kind(study->file, node) == YAML_SCALAR && strlen(value) < SCENE_TEXT_SIZE;
    if (!fits) return yaml_refuse(study->file, node, key, "a text of at most 511 bytes", err);
    memcpy(text, value, strlen(value) + 1);
    return true;
}

// Wrong values are found when scenes are made, point by point (study_point).
bool study_read(const char *path, const char *const *overrides, int32_t override_count,
                bool trusted, Study *study, Error *err)
{
    static const char *const keeps[] = {"points", "table"};
    char scene[SCENE_TEXT_SIZE] = "";
    int32_t choice = 0;
    *study = (Study){.set = YAML_NO_NODE, .cases = YAML_NO_NODE, .rank.baseline = YAML_NO_NODE};
    if (strlen(path) >= sizeof study->path)
        return REFUSE(err, "%.80s...: a path of more than 511 bytes", path);
    memcpy(study->path, path, strlen(path) + 1);
    if (!yaml_read(path, &study->file, err)) return false;
    if (yaml_kind(study->file, YAML_ROOT) != YAML_MAP)
        return yaml_error(study->file, YAML_ROOT, err,
                          "not a study: a study is a map of keys, as in `scene: fig1.yaml`");

    // A mistyped key would silently change the study.
    WantedKey keys[] = {{.name = "title"}, {.name = "scene"},  {.name = "set"},   {.name = "cases"},
                        {.name = "vary"},  {.name = "record"}, {.name = "keep"},  {.name = "rank"},
                        {.name = "plot"},  {.name = "search"}, {.name = "where"}, {.name = "best"},
                        {.name = "fit"}};
    if (!wanted_find(study->file, YAML_ROOT, "study", keys, sizeof keys / sizeof *keys, err))
        return false;
    if (!yaml_parse("what a sweep sets", STUDY_STANDARD, 0, &study->made[0], err)) return false;
    study->standard = study->made[study->made_count++];

    // The scene's path is relative to the study's folder, whatever the working directory.
    if (!read_text(study, "title", study->title, err)) return false;
    if (!read_text(study, "scene", scene, err)) return false;
    if (!*scene)
        return yaml_error(
            study->file, YAML_ROOT, err,
            "scene: must be given: the scene that is varied, as in `scene: fig1.yaml`");
    if (!open_check_named(scene, err)) {
        error_context(err, "%s: scene", study->path);
        return false;
    }
    if (!folder_beside(study->path, scene, study->scene, sizeof study->scene))
        return REFUSE(err, "%s: the path of the scene is longer than 511 bytes", study->path);

    if (!read_changes(study, overrides, override_count, err)) return false;
    if (!read_search(study, err) || !study_read_wanted(study, err)) return false;
    WantedKey keep = {"keep", yaml_look_up(study->file, "keep")};
    if (!wanted_choice(study->file, &keep, keeps, 2, &choice, err)) return false;
    study->keep_table = choice == 1;
    return scene_source_open(study->scene, trusted, &study->source, err);
}
