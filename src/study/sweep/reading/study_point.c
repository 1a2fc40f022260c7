// SPDX-License-Identifier: GPL-2.0-or-later
// The scene of one point of a study: its settings, in order.
#include "study/sweep/reading/study.h"

#include "base/memory.h"
#include "scene/formulas.h"
#include "scene/keys.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct PointSettings {
    SceneSetting list[STUDY_SETTINGS_MAX];
    int32_t count;
} PointSettings;

// --- values of a scene --------------------------------------------------------------------------

// Twelve digits: what a user typed comes back as it was typed. A key that is not given and has no
// default (rod.stiffness) has no value: it is not 0.
void study_scene_value(const Scene *scene, const char *key, char *words, int32_t size,
                       double *number)
{
    const MeshParameter *parameter = scene_mesh_parameter(scene, key);
    int32_t index = scene_key_index(key), count = 0;
    const SceneKey *keys = scene_keys(&count);
    *words = 0;
    *number = NAN;
    if (index >= 0 && scene_key_may_lack(&keys[index]) && !scene->given[index]) return;
    if (scene_number(scene, key, number))
        snprintf(words, (size_t)size, "%.12g", *number);
    else if (parameter)
        snprintf(words, (size_t)size, "%s", parameter->text);
    else if (index >= 0)
        scene_key_value(&keys[index], scene, words, size);
    if (index >= 0 && keys[index].type == KEY_FLAG) *number = strcmp(words, "true") == 0;
}

void study_add_words(const Scene *scene, const char *key, char *words, int32_t size)
{
    char text[160];
    double number = 0;
    size_t used = strlen(words), room = (size_t)size - used;
    study_scene_value(scene, key, text, sizeof text, &number);
    int length =
        snprintf(words + used, room, "%s%s=%s", used ? " " : "", key, *text ? text : "none");
    if (length < 0 || (size_t)length >= room) words[used] = 0;   // what does not fit is left out
}

// --- gathering ----------------------------------------------------------------------------------

static bool add(PointSettings *settings, const SceneSetting *setting, Error *err)
{
    if (settings->count == STUDY_SETTINGS_MAX)
        return REFUSE(err, "more than %d settings for a point of a study", STUDY_SETTINGS_MAX);
    settings->list[settings->count++] = *setting;
    return true;
}

static bool add_map(PointSettings *settings, const YamlDocument *document, YamlNode map, Error *err)
{
    if (map == YAML_NO_NODE) return true;
    YAML_EACH (item, document, map) {
        SceneSetting setting = {
            .key = yaml_key(document, item), .document = document, .node = item};
        if (!add(settings, &setting, err)) return false;
    }
    return true;
}

bool study_scene(const Study *study, const PointChoice *choice, Scene *scene, Error *err)
{
    PointSettings *settings = NEW_ARRAY(PointSettings, 1, err);
    TRY(settings);

    // Later settings win: a sweep's standards, `set`, --set, the case, what varies, `changes`.
    int32_t index[STUDY_AXES_MAX], point = choice->point;
    for (int32_t k = study->axis_count - 1; k >= 0; k--) {
        index[k] = point % study->axes[k].count;
        point /= study->axes[k].count;
    }
    TRY(add_map(settings, study->standard, YAML_ROOT, err));
    TRY(add_map(settings, study->file, study->set, err));

    // A formula of `set` that --set replaces is not worked out.
    int32_t kept = 0;
    for (int32_t k = 0; k < settings->count; k++) {
        const SceneSetting *setting = &settings->list[k];
        bool replaced = false;
        for (int32_t i = 0; i < study->override_count; i++)
            replaced = replaced || strcmp(study->override_keys[i], setting->key) == 0;
        if (!replaced || !scene_is_formula(setting->document, setting->node))
            settings->list[kept++] = *setting;
    }
    settings->count = kept;

    for (int32_t k = 0; k < study->override_count; k++)
        TRY(add(settings, &study->overrides[k], err));
    const StudyCase *one = choice->trial      ? choice->trial
                           : study->case_list ? &study->case_list[point]
                                              : NULL;
    if (one) TRY(add_map(settings, one->document, one->map, err));
    for (int32_t k = 0; k < study->axis_count; k++) {
        const StudyAxis *axis = &study->axes[k];
        SceneSetting setting = {
            .key = axis->key, .document = axis->document, .node = axis->values[index[k]]};
        TRY(add(settings, &setting, err));
    }
    if (choice->baseline) TRY(add_map(settings, study->file, study->rank.baseline, err));
    TRY(scene_source_make(study->source, settings->list, settings->count, scene, err));
cleanup:
    memory_free(settings);
    return error_is_clean(err);
}
