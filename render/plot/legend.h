// SPDX-License-Identifier: GPL-2.0-or-later
// The legend of a plot: series that have a label, in their order, a sample and words each, in lines
// below the frame. Called by plot_draw.
#ifndef AMONTONS_RENDER_PLOT_LEGEND_H
#define AMONTONS_RENDER_PLOT_LEGEND_H

#include "render/plot/plot.h"

// Pixels that its lines take over the room's width.
double legend_height(const Page *page, const PlotPanel *panel, const Box *room);
void legend_draw(const Page *page, const PlotPanel *panel, const Box *room);

#endif
