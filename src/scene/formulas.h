// SPDX-License-Identifier: GPL-2.0-or-later
// Values of a scene that are worked out of its others: `= 6 * load.pressure`.
#ifndef AMONTONS_SCENE_FORMULAS_H
#define AMONTONS_SCENE_FORMULAS_H

#include "base/formula.h"
#include "scene/scene.h"

// `= 0.5 * mesh.set.length`; in quotes it is a text that begins with `=`.
bool scene_is_formula(const YamlDocument *document, YamlNode node);

// A FormulaLookUp over a scene: its numbers, and those of the mesh's parameters and of materials.
bool scene_number(const void *scene, const char *name, double *value);

enum { SCENE_NUMBER_SIZE = 40 };   // of a number with 15 digits

// The value of a formula over the numbers that `look_up` gives, written with 15 digits: what
// messages and tables show is what is computed with.
bool scene_formula_number(const SceneSetting *formula, FormulaLookUp look_up, const void *context,
                          char text[SCENE_NUMBER_SIZE], Error *err);

const MeshParameter *scene_mesh_parameter(const Scene *scene, const char *key);   // NULL: none

#endif
