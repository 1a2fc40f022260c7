// SPDX-License-Identifier: GPL-2.0-or-later
// Where the legend of a plot hides least of its data. Geometry only: nothing is drawn here. Called
// by figure_curves.
#ifndef AMONTONS_RENDER_PLOT_LEGEND_PLACE_H
#define AMONTONS_RENDER_PLOT_LEGEND_PLACE_H

#include "render/plot/plot.h"

typedef struct LegendSize {
    double width, height;   // of samples and words, pixels
    double margin;   // between them and the frame, pixels
    double clearance;   // data nearer than this to the words is in their way, pixels
    double mark;   // radius of the data's marks, pixels
} LegendSize;

// The legend's place in a corner of the frame, or for CORNER_OUTSIDE right of it at its top.
Box legend_box(const Axes *axes, const LegendSize *size, PlotCorner corner);

// How much of the data a legend at `box` would hide: the length of the lines and error bars below
// it, and the width of the marks, pixels.
double legend_hides(const PlotPanel *panel, const Axes *axes, const LegendSize *size,
                    const Box *box);

// The corner in which the legend hides nothing, and touches nothing of `taken` (an inset; NULL:
// none), the first of the enum's order; where there is no such corner CORNER_OUTSIDE, or if that
// would leave the frame too little of its width, the corner in which it hides least.
PlotCorner legend_choose(const PlotPanel *panel, const Axes *axes, const LegendSize *size,
                         const Box *taken);

#endif
