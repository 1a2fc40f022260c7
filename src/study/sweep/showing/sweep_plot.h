// SPDX-License-Identifier: GPL-2.0-or-later
// A plot of a stored sweep, figures/NAME.png: curves, or a map, perhaps in panels. Called by sweep
// and render_sweep.
#ifndef AMONTONS_STUDY_SWEEP_SHOWING_SWEEP_PLOT_H
#define AMONTONS_STUDY_SWEEP_SHOWING_SWEEP_PLOT_H

#include "amontons.h"
#include "study/sweep/reading/study.h"

// Draws a plot of the sweep in `folder`, which holds its table. The path of measurements is seen
// from `beside` (the study; NULL: from the working folder). style: NULL is fine.
bool sweep_plot_draw(const char *folder, const char *beside, const StudyPlot *plot,
                     const PictureStyle *style, Error *err);

#endif
