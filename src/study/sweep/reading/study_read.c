// SPDX-License-Identifier: GPL-2.0-or-later
// A study's file: which keys it may have, its title and its scene. study_vary and study_wanted read
// the rest.
#include "study/sweep/reading/study_read.h"

#include "base/text.h"
#include "study/sweep/reading/study_search.h"
#include "study/sweep/reading/study_vary.h"
#include "study/sweep/reading/study_wanted.h"

#include <stdio.h>
#include <string.h>

// A mistyped key would silently change the study.
static bool check_keys(const Study *study, Error *err)
{
    static const char *const known[] = {"title",  "scene", "set",  "cases",  "vary",
                                        "record", "keep",  "rank", "search", "where",
                                        "best",   "fit",   "plot"};
    enum { COUNT = sizeof known / sizeof known[0] };
    YAML_EACH (item, study->file, YAML_ROOT) {
        const char *key = yaml_key(study->file, item);
        bool is_known = false;
        for (int32_t k = 0; k < COUNT; k++) is_known = is_known || strcmp(key, known[k]) == 0;
        if (is_known) continue;
        char hint[TEXT_HINT_SIZE];
        return yaml_key_error(study->file, item, err, "%.60s: unknown key of a study%s", key,
                              text_hint(key, known, COUNT,
                                        "; allowed: title, scene, set, cases, vary, record, keep, "
                                        "rank, plot, search, where, best, fit",
                                        hint));
    }
    return true;
}

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

// Relative to the study's folder, whatever the working directory.
static bool read_scene_path(Study *study, Error *err)
{
    char given[SCENE_TEXT_SIZE] = "";
    if (!read_text(study, "scene", given, err)) return false;
    if (!*given)
        return yaml_error(
            study->file, YAML_ROOT, err,
            "scene: must be given: the scene that is varied, as in `scene: fig1.yaml`");
    const char *slash = strrchr(study->path, '/');
    int folder = slash && *given != '/' ? (int)(slash - study->path) + 1 : 0;
    if (snprintf(study->scene, sizeof study->scene, "%.*s%s", folder, study->path, given) >=
        (int)sizeof study->scene)
        return REFUSE(err, "%s: the path of the scene is longer than 511 bytes", study->path);
    return error_is_clean(err);
}

static bool read_keep(Study *study, Error *err)
{
    YamlNode node = yaml_look_up(study->file, "keep");
    if (node == YAML_NO_NODE) return true;
    const char *word = yaml_kind(study->file, node) == YAML_SCALAR ? yaml_text(study->file, node)
                                                                   : "";
    study->keep_table = strcmp(word, "table") == 0;
    if (study->keep_table || strcmp(word, "points") == 0) return true;
    return yaml_refuse(study->file, node, "keep", "points or table", err);
}

// What is wrong with values shows when scenes are made, point by point (study_point).
bool study_read(const char *path, const char *const *overrides, int32_t override_count,
                Study *study, Error *err)
{
    *study = (Study){.set = YAML_NO_NODE, .cases = YAML_NO_NODE, .rank.baseline = YAML_NO_NODE};
    if (strlen(path) >= sizeof study->path)
        return REFUSE(err, "%.80s...: a path of more than 511 bytes", path);
    memcpy(study->path, path, strlen(path) + 1);
    if (!yaml_read(path, &study->file, err)) return false;
    if (yaml_kind(study->file, YAML_ROOT) != YAML_MAP)
        return yaml_error(study->file, YAML_ROOT, err,
                          "not a study: a study is a map of keys, as in `scene: fig1.yaml`");
    if (!check_keys(study, err)) return false;
    if (!yaml_parse("what a sweep sets", STUDY_STANDARD, 0, &study->made[0], err)) return false;
    study->standard = study->made[study->made_count++];
    return read_text(study, "title", study->title, err) && read_scene_path(study, err) &&
           study_read_vary(study, overrides, override_count, err) &&
           study_read_search(study, err) && study_read_wanted(study, err) &&
           read_keep(study, err) && scene_source_open(study->scene, &study->source, err);
}
