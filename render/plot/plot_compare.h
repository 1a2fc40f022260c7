// SPDX-License-Identifier: GPL-2.0-or-later
// Measurements from a table of comma-separated values over the curves of a plot: one more series,
// with the misfit in its label. Called by plot_draw.
#ifndef AMONTONS_RENDER_PLOT_PLOT_COMPARE_H
#define AMONTONS_RENDER_PLOT_PLOT_COMPARE_H

#include "render/plot/plot.h"

// The columns are those that the axes name (`column`), or x and y; `error`, or the second column's
// name with _error behind it, is the bar. The misfit is the root of the mean square of measured
// less computed, linear between the points of the curve (over logarithms where the axis has them),
// over those that it covers; in parts of the errors too where all have one. Where a plot has
// several curves there is none. ERROR_INPUT: a column is missing, or the plot is a map.
bool plot_compare(Plot *plot, const char *path, Error *err);

// Each measurement with what was computed there, into PICTURE-compared.csv, if anything is.
bool plot_compare_write(const Plot *plot, const char *picture, Error *err);

#endif
