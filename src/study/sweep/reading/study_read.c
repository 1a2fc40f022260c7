// SPDX-License-Identifier: GPL-2.0-or-later
// A study's file: which keys it may have, its title and its scene. study_vary and study_wanted read
// the rest.
#include "study/sweep/reading/study_read.h"

#include "io/files/folder.h"
#include "study/sweep/reading/study_search.h"
#include "study/sweep/reading/study_vary.h"
#include "study/sweep/reading/study_wanted.h"
#include "study/sweep/reading/wanted_keys.h"

#include <stdio.h>
#include <string.h>

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
    if (!folder_beside(study->path, given, study->scene, sizeof study->scene))
        return REFUSE(err, "%s: the path of the scene is longer than 511 bytes", study->path);
    return error_is_clean(err);
}

static bool read_keep(Study *study, Error *err)
{
    static const char *const words[] = {"points", "table"};
    WantedKey keep = {"keep", yaml_look_up(study->file, "keep")};
    int32_t choice = 0;
    if (!wanted_choice(study->file, &keep, words, 2, &choice, err)) return false;
    study->keep_table = choice == 1;
    return true;
}

// Wrong values are found when scenes are made, point by point (study_point).
bool study_read(const char *path, const char *const *overrides, int32_t override_count,
                bool trusted, Study *study, Error *err)
{
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
    return read_text(study, "title", study->title, err) && read_scene_path(study, err) &&
           study_read_vary(study, overrides, override_count, err) &&
           study_read_search(study, err) && study_read_wanted(study, err) &&
           read_keep(study, err) && scene_source_open(study->scene, trusted, &study->source, err);
}
