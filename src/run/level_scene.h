// SPDX-License-Identifier: GPL-2.0-or-later
// Changes that the runs behind an error bar (run/accuracy) make to their scene: mesh and loads.
#ifndef AMONTONS_RUN_LEVEL_SCENE_H
#define AMONTONS_RUN_LEVEL_SCENE_H

#include "scene/scene.h"

// The parameter `refine` of every mesh, times what the scene may have set it to. ERROR_INPUT: there
// is no room for it.
bool scene_refine(Scene *scene, double refine, Error *err);
void scene_scale_loads(Scene *scene, double factor);   // pressure and tractions

#endif
