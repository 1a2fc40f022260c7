// SPDX-License-Identifier: GPL-2.0-or-later
// output.window of a scene, as the definition of record/observation.
#ifndef AMONTONS_SCENE_WINDOW_H
#define AMONTONS_SCENE_WINDOW_H

#include "record/observation.h"
#include "scene/scene.h"

WindowDef scene_window(const Scene *scene);

#endif
