// SPDX-License-Identifier: GPL-2.0-or-later
// Lists are bounded (study.h), so that a typing error ends in a message and not in a week of runs.
#include "study/sweep/reading/study_vary.h"

#include "base/memory.h"
#include "scene/formulas.h"
#include "scene/keys.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const char AXIS_ALLOWED[] = "a list of values, {log: [from, to], points: n} or "
                                   "{linear: [from, to], points: n}";

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

// The first column that a value given under `key` sets, by itself or in the map it is, and that is
// one of `among`; NULL: none.
static const char *find_given(const Study *study, const bool *among, const char *key,
                              const YamlDocument *document, YamlNode node)
{
    int32_t column = study_column(study, key);
    if (column >= 0 && among[column]) return study->columns[column];
    YAML_EACH (item, document, node) {
        char path[STUDY_NAME_SIZE];
        snprintf(path, sizeof path, "%.40s.%.50s", key, yaml_key(document, item));
        const char *found = find_given(study, among, path, document, item);
        if (found) return found;
    }
    return NULL;
}

// Refuses an item of `what` that gives a key that varies. A formula of `cases` over that key itself
// (= 2 * load.pressure) takes what varies, and is no second value.
static bool check_given(const Study *study, const char *what, YamlNode item, bool takes, Error *err)
{
    const char *found =
        find_given(study, study->varied, yaml_key(study->file, item), study->file, item);
    if (!found || (takes && scene_is_formula(study->file, item) &&
                   strstr(yaml_text(study->file, item), found)))
        return true;
    return yaml_key_error(study->file, item, err, "%s: given by `%s` and again by `vary`", found,
                          what);
}

// Whether the key can be set is known here; whether its value is right when a scene is made.
bool study_check_key(const YamlDocument *document, YamlNode item, Error *err)
{
    const char *key = yaml_key(document, item), *nearest = scene_key_nearest(key), *part;
    int32_t above = scene_key_above(key, &part), count;
    bool is_state = above >= 0 && scene_keys(&count)[above].items == &scene_state_items;
    bool is_known = scene_key_index(key) >= 0 || scene_key_is_group(key) ||
                    (above >= 0 && !is_state);   // numbers of states are not read back
    if (strlen(key) >= STUDY_NAME_SIZE)
        yaml_key_error(document, item, err, "a key of more than %d bytes", STUDY_NAME_SIZE - 1);
    else if (!is_known)
        yaml_key_error(document, item, err,
                       "%s: unknown key of a scene%s%s%s (`amontons info keys` lists them all)",
                       key, nearest ? "; did you mean `" : "", nearest ? nearest : "",
                       nearest ? "`?" : "");
    return error_is_clean(err);
}

// Formulas make columns, since their values differ from point to point; plain values do not.
static bool read_set(Study *study, Error *err)
{
    study->set = yaml_look_up(study->file, "set");
    if (study->set == YAML_NO_NODE) return true;
    if (yaml_kind(study->file, study->set) != YAML_MAP)
        return yaml_refuse(study->file, study->set, "set", "a map of the scene's keys", err);
    YAML_EACH (item, study->file, study->set) {
        if (!study_check_key(study->file, item, err)) return false;
        if (!check_given(study, "set", item, false, err)) return false;
        if (scene_is_formula(study->file, item) &&
            study_add_column(study, yaml_key(study->file, item), err) < 0)
            return false;
    }
    return error_is_clean(err);
}

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
            if (!study_check_key(document, item, err)) return false;
            if (!add_columns(study, yaml_key(document, item), document, item, false, err))
                return false;
        }
        if (!error_is_clean(err)) return false;
    }
    return error_is_clean(err);
}

// --- ranges -------------------------------------------------------------------------------------

// {log: [from, to], points: n} or {linear: [from, to], points: n}; ends are met exactly, what lies
// between is rounded to 6 digits, so that it can be quoted.
// *text: a YAML list, the caller's to free, so that values of a range are read by the same parser
// as those in the file.
static bool write_range(const double bounds[2], const char *unit, bool is_log, int32_t points,
                        char **text, Error *err)
{
    enum { NUMBER_SIZE = 32 + STUDY_UNIT_SIZE };
    double from = bounds[0], to = bounds[1];
    *text = NEW_ARRAY(char, (int64_t)points *NUMBER_SIZE + 8, err);
    if (!*text) return false;
    int64_t used = 1;
    (*text)[0] = '[';
    for (int32_t k = 0; k < points; k++) {
        double part = points > 1 ? (double)k / (points - 1) : 0;
        double value = is_log ? from * pow(to / from, part) : from + (to - from) * part;
        int digits = 6;
        if (k == 0 || k == points - 1) {
            value = k == 0 ? from : to;
            for (digits = 6; digits < 17; digits++) {
                char trial[NUMBER_SIZE];
                snprintf(trial, sizeof trial, "%.*g", digits, value);
                if (strtod(trial, NULL) == value) break;
            }
        }
        used += snprintf(*text + used, NUMBER_SIZE, "%s%.*g%s", k ? ", " : "", digits, value, unit);
    }
    (*text)[used] = ']';
    return true;
}

// The document made of it belongs to the study (made), and errors in its values name the range's
// place.
static bool read_range(Study *study, YamlNode node, StudyAxis *axis, Error *err)
{
    WantedKey keys[] = {{.name = "log"}, {.name = "linear"}, {.name = "points"}};
    double bounds[2] = {0, 0};
    int32_t count = 0;
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
    if (!study_whole(study, &keys[2], STUDY_RANGE_MAX, &count, err)) return false;
    TRY(write_range(bounds, unit, is_log, count, &text, err));
    snprintf(name, sizeof name, "%s:%d:%d, values of the range", study->path,
             yaml_line(study->file, node), yaml_column(study->file, node));
    TRY(yaml_parse(name, text, 0, &study->made[study->made_count], err));
    axis->document = study->made[study->made_count++];
    axis->list = YAML_ROOT;
cleanup:
    memory_free(text);
    return error_is_clean(err);
}

// --- axes ---------------------------------------------------------------------------------------

// A key of `vary`: a list of values, or those of a range, made into a document of their
// own.
static bool read_axis(Study *study, YamlNode item, Error *err)
{
    StudyAxis *axis = &study->axes[study->axis_count];
    if (!study_check_key(study->file, item, err)) return false;
    snprintf(axis->key, sizeof axis->key, "%s", yaml_key(study->file, item));
    axis->document = study->file;
    axis->list = item;
    YamlKind kind = yaml_kind(study->file, item);
    if (kind == YAML_MAP && !read_range(study, item, axis, err)) return false;
    axis->count = yaml_count(axis->document, axis->list);
    if ((kind != YAML_MAP && kind != YAML_LIST) || axis->count == 0)
        return yaml_refuse(study->file, item, axis->key, AXIS_ALLOWED, err);
    if (!study_list(axis->document, axis->list, &axis->values, err)) return false;
    study->axis_count++;
    YAML_EACH (value, axis->document, axis->list) {
        const char *found = find_given(study, study->varied, axis->key, axis->document, value);
        if (found) return yaml_key_error(study->file, item, err, "%s: varied twice", found);
    }
    YAML_EACH (value, axis->document, axis->list)
        if (!add_columns(study, axis->key, axis->document, value, true, err)) return false;
    return error_is_clean(err);
}

static bool read_vary(Study *study, Error *err)
{
    YamlNode vary = yaml_look_up(study->file, "vary");
    if (vary == YAML_NO_NODE) return true;
    if (yaml_kind(study->file, vary) != YAML_MAP || yaml_count(study->file, vary) > STUDY_AXES_MAX)
        return yaml_refuse(study->file, vary, "vary", "a map of at most 16 keys of the scene", err);
    YAML_EACH (item, study->file, vary)
        if (!read_axis(study, item, err)) return false;
    return error_is_clean(err);
}

// A key has one value at a point, from one place. Cases may replace what `set` gives: it is what
// the other cases have.
static bool check_cases(const Study *study, Error *err)
{
    if (study->cases == YAML_NO_NODE) return true;
    YAML_EACH (one, study->file, study->cases)
        YAML_EACH (item, study->file, one)
            if (!check_given(study, "cases", item, true, err)) return false;
    return error_is_clean(err);
}

// A key that varies is refused, rather than silently losing to `vary`.
static bool read_override(Study *study, const char *text, Error *err)
{
    char shown[STUDY_NAME_SIZE + 8];
    char *key = study->override_keys[study->override_count];
    const char *equals = strchr(text, '=');
    if (!equals || equals == text || equals - text >= STUDY_NAME_SIZE)
        return REFUSE(err, "--set %.80s: expected key=value, as in load.pressure=0.006", text);
    memcpy(key, text, (size_t)(equals - text));
    snprintf(shown, sizeof shown, "--set %s", key);
    YamlDocument **document = &study->made[study->made_count];
    if (!yaml_parse(shown, text, (int32_t)(equals - text) + 1, document, err)) return false;
    study->made_count++;
    const char *found = find_given(study, study->chosen, key, *document, YAML_ROOT);
    if (found) return REFUSE(err, "--set %s: %s varies %s", key, study->path, found);
    study->overrides[study->override_count++] =
        (SceneSetting){.key = key, .document = *document, .node = YAML_ROOT};
    return true;
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

// `cases` and `vary` decide which keys are columns; --set refuses those, and is read after them;
// `set` comes after --set, which may replace a formula.
bool study_read_vary(Study *study, const char *const *overrides, int32_t override_count, Error *err)
{
    if (override_count > STUDY_SETTINGS_MAX - STUDY_AXES_MAX - 1)
        return REFUSE(err, "more than %d settings by --set",
                      STUDY_SETTINGS_MAX - STUDY_AXES_MAX - 1);
    study->case_count = 1;
    study->cases = yaml_look_up(study->file, "cases");
    if (study->cases != YAML_NO_NODE && !read_cases(study, study->file, study->cases, err))
        return false;
    if (!read_vary(study, err)) return false;
    for (int32_t k = 0; k < override_count; k++)
        if (!read_override(study, overrides[k], err)) return false;
    return read_set(study, err) && check_cases(study, err) && count_points(study, err);
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
