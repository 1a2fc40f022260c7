// SPDX-License-Identifier: GPL-2.0-or-later
#include "scene/formulas.h"

#include "scene/keys.h"
#include "scene/materials.h"

#include <stdio.h>
#include <string.h>

bool scene_is_formula(const YamlDocument *document, YamlNode node)
{
    return yaml_kind(document, node) == YAML_SCALAR && !yaml_is_quoted(document, node) &&
           yaml_text(document, node)[0] == '=';
}

const MeshParameter *scene_mesh_parameter(const Scene *scene, const char *key)
{
    static const char prefix[] = "mesh.set.";
    if (strncmp(key, prefix, strlen(prefix)) != 0) return NULL;
    for (int32_t k = 0; k < scene->mesh.parameter_count; k++)
        if (strcmp(scene->mesh.parameters[k].name, key + strlen(prefix)) == 0)
            return &scene->mesh.parameters[k];
    return NULL;
}

bool scene_number(const void *context, const char *name, double *value)
{
    const Scene *scene = context;
    const MeshParameter *parameter = scene_mesh_parameter(scene, name);
    int32_t index = scene_key_index(name), count = 0;
    const SceneKey *keys = scene_keys(&count);
    if (parameter) {
        *value = parameter->value;
        return !*parameter->text;
    }
    if (scene_materials_find(scene, name, value) || scene_branches_find(scene, name, value))
        return true;
    if (index < 0 || keys[index].type != KEY_NUMBER) return false;
    memcpy(value, (const char *)scene + keys[index].offset, sizeof *value);
    return true;
}

bool scene_formula_number(const SceneSetting *formula, FormulaLookUp look_up, const void *context,
                          char text[SCENE_NUMBER_SIZE], Error *err)
{
    double result = 0;
    Error found = {0};
    const char *sum = yaml_text(formula->document, formula->node) + 1;
    if (!formula_value(sum, look_up, context, &result, &found))
        return yaml_error(formula->document, formula->node, err, "%s: %s", formula->key,
                          found.message);
    snprintf(text, SCENE_NUMBER_SIZE, "%.15g", result);
    return true;
}
