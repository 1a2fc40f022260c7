// SPDX-License-Identifier: GPL-2.0-or-later
// Values of a scene that are worked out of its others: `= 6 * load.pressure`. Used by
// scene/scene_read for those of the file and of --set, and by study/sweep for points of a study.
#ifndef AMONTONS_SCENE_FORMULAS_H
#define AMONTONS_SCENE_FORMULAS_H

#include "base/formula.h"
#include "scene/scene.h"

// `= 0.5 * mesh.set.length`; in quotes it is a text that begins with `=`.
bool scene_is_formula(const YamlDocument *document, YamlNode node);

// A FormulaLookUp over a scene: its numbers, and those of the mesh's parameters and of materials.
bool scene_number(const void *scene, const char *name, double *value);

// The value of a formula over the numbers that `look_up` gives, as a document of its own, called
// `name` in errors. Owned by the caller.
bool scene_formula_value(const SceneSetting *formula, const char *name, FormulaLookUp look_up,
                         const void *context, YamlDocument **value, Error *err);
// The same over `scene`.
bool scene_work_out(const Scene *scene, const SceneSetting *formula, const char *name,
                    YamlDocument **value, Error *err);

const MeshParameter *scene_mesh_parameter(const Scene *scene, const char *key);   // NULL: none

#endif
