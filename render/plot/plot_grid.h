// SPDX-License-Identifier: GPL-2.0-or-later
// Small multiples: the panels of a plot in rows and columns, with the same axes and colours.
// Numbers stand at the left and below the lowest. Called by figure_curves.
#ifndef AMONTONS_RENDER_PLOT_PLOT_GRID_H
#define AMONTONS_RENDER_PLOT_PLOT_GRID_H

#include "render/plot/plot.h"

// Size of the page: its height over its width, and a width that suits, mm.
void plot_grid_size(const Plot *plot, double *height, double *width);

// below: where the legend stands.
bool plot_grid_draw(const Page *page, const Plot *plot, const Box *below, Error *err);

#endif
