// SPDX-License-Identifier: GPL-2.0-or-later
// What the options of a picture change in a plot that has been read. Called by figure_curves.
#ifndef AMONTONS_RENDER_PLOT_PLOT_STYLE_H
#define AMONTONS_RENDER_PLOT_PLOT_STYLE_H

#include "render/plot/plot.h"

// Legend and ends of the colours as the style asks.
bool plot_take_style(Plot *plot, const PictureStyle *style, Error *err);

#endif
