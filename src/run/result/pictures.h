// SPDX-License-Identifier: GPL-2.0-or-later
// Pictures of a result, or of a plot file, that this process has written itself. Called by
// run/output, run/result/film, run/result/figure_file, run/info/info_curves and
// study/sweep/showing/render_sweep.
#ifndef AMONTONS_RUN_RESULT_PICTURES_H
#define AMONTONS_RUN_RESULT_PICTURES_H

#include "amontons.h"

// Draws as amontons_render_result does, but always in this process.
bool pictures_draw(const char *folder, const PictureRequest *request, Error *err);

// The same of a plot file, as amontons_render_plot_file does.
bool pictures_draw_plot(const char *plot, const char *picture, const PictureStyle *style,
                        Error *err);

// ERROR_INPUT: it is no folder.
bool pictures_check_folder(const char *folder, Error *err);

#endif
