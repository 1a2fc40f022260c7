// SPDX-License-Identifier: GPL-2.0-or-later
// Marks and lines of a plot's series. Called by plot_draw, plot_map and legend.
#ifndef AMONTONS_RENDER_PLOT_MARKS_H
#define AMONTONS_RENDER_PLOT_MARKS_H

#include "render/plot/plot.h"

static const double MARKER_RADIUS = 1.9;   // points

// Finds where the error bar of point k begins and ends on the picture: upright, or lying where the
// y axis has names. false: it has none, or one that the axes cannot show.
bool plot_bar_ends(const Axes *axes, const PlotSeries *series, int32_t k, Point end[2]);

// share: of the usual size and width, less in an inset.
void mark_draw(const Page *page, const PlotSeries *series, Point at, double share);
void cross_draw(const Page *page, Color color, Point at, double arm);   // arm: pixels
Color mark_color(const PlotSeries *series);
Stroke mark_stroke(const Page *page, const PlotSeries *series, double share);

#endif
