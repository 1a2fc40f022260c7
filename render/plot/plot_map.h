// SPDX-License-Identifier: GPL-2.0-or-later
// The map of a plot's panel: values in colours, lines at equal values of something else, marks at
// the points. Called by plot_draw.
#ifndef AMONTONS_RENDER_PLOT_PLOT_MAP_H
#define AMONTONS_RENDER_PLOT_PLOT_MAP_H

#include "render/canvas/colorbar.h"
#include "render/plot/plot.h"

// The same for all panels.
typedef struct MapScale {
    Colorbar bar;
    Axis contours;
} MapScale;

MapScale map_scale_fit(const Plot *plot);

// axes: those of `panel`, their frame known.
bool plot_map_draw(const Page *page, const Axes *axes, const PlotPanel *panel,
                   const MapScale *scale, Error *err);

#endif
