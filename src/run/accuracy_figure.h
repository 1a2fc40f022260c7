// SPDX-License-Identifier: GPL-2.0-or-later
// The picture of how an error bar was found: runs and means over contact nodes. Called by
// run/accuracy.
#ifndef AMONTONS_RUN_ACCURACY_FIGURE_H
#define AMONTONS_RUN_ACCURACY_FIGURE_H

#include "answers/error_bars.h"

// figures/accuracy.json (render/plot/plot_file's format, which a user may edit) and
// figures/accuracy.png in the result folder `folder`.
bool accuracy_figure(const Levels *levels, const char *title, const char *folder, Error *err);

// For a search that was stopped (`err` says where): adds to `err` what whole runs gave, and leaves
// the picture in `folder` (NULL: nowhere). Such runs write no checkpoints: there is no going on.
void accuracy_stopped(Levels *levels, const char *title, const char *folder, Error *err);

#endif
