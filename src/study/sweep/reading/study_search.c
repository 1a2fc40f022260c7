// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/sweep/reading/study_search.h"

#include "scene/formulas.h"
#include "study/sweep/reading/study_vary.h"
#include "study/sweep/reading/wanted_keys.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { DESIGNS_FEWEST = 20, DESIGNS_A_KEY = 10 };   // without `best: {designs: ...}`

static const char KEY_ALLOWED[] = "{linear: [least, most]}, {log: [least, most]} or "
                                  "{whole: [least, most]}";

// {log: [0.01, 0.2]}
static bool read_key(Study *study, YamlNode item, Error *err)
{
    static const char *const scales[] = {"linear", "log", "whole"};
    StudySearch *search = &study->search;
    SearchKey *key = &search->keys[search->key_count];
    YamlNode range = yaml_first(study->file, item);
    if (!study_check_key(study->file, item, err)) return false;
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
    if (study_is_chosen(study, key->key))
        return yaml_key_error(study->file, item, err, "%s: searched, and given by `vary` as well",
                              key->key);
    return study_add_column(study, key->key, err) >= 0;
}

// {value: = mesh.set.n * mesh.set.pad_height, least: 0.1, most: 0.6}
static bool read_limit(Study *study, YamlNode item, Error *err)
{
    WantedKey keys[] = {{.name = "value"}, {.name = "least"}, {.name = "most"}};
    SearchLimit *limit = &study->search.limits[study->search.limit_count++];
    *limit = (SearchLimit){YAML_NO_NODE, -INFINITY, INFINITY};
    if (!wanted_find(study->file, item, "where", keys, 3, err)) return false;
    limit->formula = keys[0].node;
    if (limit->formula == YAML_NO_NODE || !scene_is_formula(study->file, limit->formula))
        return yaml_refuse(study->file, item, "where",
                           "{value: = a formula, least: number, most: number}", err);
    for (int32_t k = 1; k < 3; k++)
        if (keys[k].node != YAML_NO_NODE &&
            !study_plain_number(study, keys[k].node, k == 1 ? &limit->least : &limit->most))
            return yaml_refuse(study->file, keys[k].node, keys[k].name, "a number", err);
    if (!(limit->least <= limit->most) || (isinf(limit->least) && isinf(limit->most)))
        return yaml_refuse(study->file, item, "where", "`least`, `most`, or both, `most` not below",
                           err);
    return error_is_clean(err);
}

static bool read_where(Study *study, Error *err)
{
    YamlNode where = yaml_look_up(study->file, "where");
    if (where == YAML_NO_NODE) return true;
    if (yaml_kind(study->file, where) != YAML_LIST ||
        yaml_count(study->file, where) > STUDY_LIMITS_MAX)
        return yaml_refuse(study->file, where, "where", "a list of at most 16 limits", err);
    YAML_EACH (item, study->file, where)
        if (!read_limit(study, item, err)) return false;
    return error_is_clean(err);
}

static bool read_sure(const Study *study, const WantedKey *key, double *sure, Error *err)
{
    static const char *const shares[] = {"95%", "68%", "90%", "99%"};
    static const double values[] = {0.95, 0.68, 0.90, 0.99};
    int32_t choice = 0;
    if (!wanted_choice(study->file, key, shares, 4, &choice, err)) return false;
    *sure = values[choice];
    return true;
}

// `best`, or `fit`, which has `measured` and `sure` in place of `over`.
static bool read_goal(Study *study, Error *err)
{
    static const char *const over[] = {"worst", "mean", "deviation", "front"};
    StudySearch *search = &study->search;
    WantedKey keys[] = {{.name = "designs"}, {.name = "seed"}, {.name = "over"}, {.name = "sure"}};
    YamlNode goal = yaml_look_up(study->file, search->fits ? "fit" : "best");
    int32_t choice = 0, seed = 1;
    search->designs = DESIGNS_FEWEST + DESIGNS_A_KEY * search->key_count;
    if (search->fits) keys[2].name = "measured";
    if (goal != YAML_NO_NODE) {
        if (!wanted_find(study->file, goal, search->fits ? "fit" : "best", keys,
                         search->fits ? 4 : 3, err))
            return false;
        if (!study_whole(study, &keys[0], STUDY_DESIGNS_MAX, &search->designs, err)) return false;
        if (!study_whole(study, &keys[1], INT32_MAX, &seed, err)) return false;
        if (!search->fits && !wanted_choice(study->file, &keys[2], over, 4, &choice, err))
            return false;
    }
    search->over = (SearchOver)choice;
    search->seed = (uint32_t)seed;
    if (!search->fits) return true;
    search->measured = keys[2].node;
    if (!read_sure(study, &keys[3], &search->sure, err)) return false;
    if (search->measured == YAML_NO_NODE)
        yaml_error(study->file, goal, err,
                   "fit: `measured` must be given: a table, as in {measured: measured.csv}");
    return error_is_clean(err);
}

// A study has one aim.
static bool check_goal(Study *study, Error *err)
{
    YamlNode fit = yaml_look_up(study->file, "fit"), best = yaml_look_up(study->file, "best");
    study->search.fits = fit != YAML_NO_NODE;
    if (!study->search.fits) return true;
    if (best != YAML_NO_NODE)
        yaml_key_error(study->file, best, err, "best: not in a study with `fit`");
    else if (study->axis_count > 0)
        yaml_error(study->file, yaml_look_up(study->file, "vary"), err,
                   "vary: in a study with `fit` conditions are columns of what was measured");
    return error_is_clean(err);
}

// Refuses the keys of a search in a study that does not search.
static bool refuse_rest(const Study *study, Error *err)
{
    static const char *const rest[] = {"where", "best", "fit"};
    for (int32_t k = 0; k < 3; k++) {
        YamlNode node = yaml_look_up(study->file, rest[k]);
        if (node == YAML_NO_NODE) continue;
        return yaml_key_error(study->file, node, err, "%s: only of a study with `search`", rest[k]);
    }
    return true;
}

bool study_read_search(Study *study, Error *err)
{
    StudySearch *search = &study->search;
    search->node = yaml_look_up(study->file, "search");
    if (search->node == YAML_NO_NODE) return refuse_rest(study, err);
    int32_t count = yaml_count(study->file, search->node);
    if (yaml_kind(study->file, search->node) != YAML_MAP || count < 1 || count > STUDY_SEARCH_MAX)
        return yaml_refuse(study->file, search->node, "search",
                           "a map of 1 to 12 keys of the scene", err);
    if (study->cases != YAML_NO_NODE)
        return yaml_error(study->file, study->cases, err,
                          "cases: a study with `search` makes its own; conditions go under `vary`");
    YAML_EACH (item, study->file, search->node)
        if (!read_key(study, item, err)) return false;
    return read_where(study, err) && check_goal(study, err) && read_goal(study, err);
}
