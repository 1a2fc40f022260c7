// SPDX-License-Identifier: GPL-2.0-or-later
// The map `materials`: what differs from `material` in regions of the mesh. Read by
// scene/scene_read, shown by scene/json and scene/key_words, made into materials by
// model/assemble.
#ifndef AMONTONS_SCENE_MATERIALS_H
#define AMONTONS_SCENE_MATERIALS_H

#include "scene/keys.h"

// Number k of a region: its own, or else that of `material`.
double scene_material_number(const Scene *scene, const SceneMaterial *region, int32_t k);

// The branches of a region (NULL: of `material`): its own, or else those of `material`.
const SceneRelaxation *scene_material_relaxation(const Scene *scene, const SceneMaterial *region);

// Name of material k of a model: 0 is `material`, then the regions follow in their order.
const char *scene_region_name(const Scene *scene, int32_t k);

// The number at a path of keys ("materials.pads.young"). false: none is given there.
bool scene_materials_find(const Scene *scene, const char *path, double *number);
// The same of branches, counted from 0 ("material.relaxation.0.shear",
// "materials.pads.relaxation.1.time").
bool scene_branches_find(const Scene *scene, const char *path, double *number);

#endif
