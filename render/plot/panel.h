// SPDX-License-Identifier: GPL-2.0-or-later
// One frame of a plot with all that is in it. Called by figure_curves and plot_grid.
#ifndef AMONTONS_RENDER_PLOT_PANEL_H
#define AMONTONS_RENDER_PLOT_PANEL_H

#include "render/plot/figure_map.h"

typedef struct PanelDef {
    const PlotPanel *panel;
    const PlotPanel *common;   // drawn over it: what all panels show; NULL: nothing
    const MapScale *scale;   // of maps
    double share;   // of the usual size of marks and lines
} PanelDef;

// axes: with the frame; drawn last.
bool panel_draw(const Page *page, const PanelDef *def, const Axes *axes, Error *err);

#endif
