// SPDX-License-Identifier: GPL-2.0-or-later
// The scene of one point of a study: settings are gathered in order, then the formulas are worked
// out one by one, each over the scene that those before it have changed.
#include "study/sweep/reading/study_point.h"

#include "base/memory.h"
#include "scene/formulas.h"
#include "scene/keys.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

typedef struct PointSettings {
    SceneSetting list[STUDY_SETTINGS_MAX];
    int32_t count;
    SceneSetting formulas[STUDY_FORMULAS_MAX];
    int32_t formula_count;
    YamlDocument *values[STUDY_FORMULAS_MAX];   // of the formulas; owned
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

// Formulas are put aside, to be worked out when all plain values are in.
static bool add(PointSettings *settings, const SceneSetting *setting, Error *err)
{
    bool is_formula = scene_is_formula(setting->document, setting->node);
    int32_t room = is_formula ? STUDY_FORMULAS_MAX : STUDY_SETTINGS_MAX;
    int32_t *count = is_formula ? &settings->formula_count : &settings->count;
    if (*count == room)
        return REFUSE(err, "more than %d %s for a point of a study", room,
                      is_formula ? "formulas" : "settings");
    (is_formula ? settings->formulas : settings->list)[(*count)++] = *setting;
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
    for (int32_t k = 0; k < settings->formula_count; k++) {
        bool replaced = false;
        for (int32_t i = 0; i < study->override_count; i++)
            replaced = replaced || strcmp(study->override_keys[i], settings->formulas[k].key) == 0;
        if (!replaced) settings->formulas[kept++] = settings->formulas[k];
    }
    settings->formula_count = kept;

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

    // The scene is made anew after each formula: the next one may use its value.
    TRY(scene_source_begin(study->source, settings->list, settings->count, scene, err));
    for (int32_t k = 0; k < settings->formula_count; k++) {
        const SceneSetting *formula = &settings->formulas[k];
        char name[SCENE_TEXT_SIZE + 120];
        snprintf(name, sizeof name, "%s:%d:%d, value of `%.80s`", study->path,
                 yaml_line(formula->document, formula->node),
                 yaml_column(formula->document, formula->node),
                 yaml_text(formula->document, formula->node));
        TRY(scene_work_out(scene, formula, name, &settings->values[k], err));
        SceneSetting value = {
            .key = formula->key, .document = settings->values[k], .node = YAML_ROOT};
        TRY(scene_source_add(study->source, &value, scene, err));
    }
cleanup:
    for (int32_t k = 0; settings && k < settings->formula_count; k++)
        yaml_destroy(settings->values[k]);
    memory_free(settings);
    return error_is_clean(err);
}
