// SPDX-License-Identifier: GPL-2.0-or-later
// Parts of a search for an error bar (run/accuracy) that it shares with its picture, or that are
// tested by themselves. amontons.h declares the part that the caller sees.
#ifndef AMONTONS_RUN_ACCURACY_H
#define AMONTONS_RUN_ACCURACY_H

#include "answers/error_bars.h"
#include "scene/scene.h"

void scene_scale_loads(Scene *scene, double factor);   // pressure and tractions

// The picture of how an error bar was found (run/accuracy_figure): runs and means over contact
// nodes. figures/accuracy.json (render/plot/plot_file's format, which a user may edit) and
// figures/accuracy.png in the result folder `folder`.
bool accuracy_figure(const Levels *levels, const char *title, const char *folder, Error *err);

// For a search that was stopped (`err` says where): adds to `err` what whole runs gave, and leaves
// the picture in `folder` (NULL: nowhere). Such runs write no checkpoints: there is no going on.
void accuracy_stopped(Levels *levels, const char *title, const char *folder, Error *err);

#endif
