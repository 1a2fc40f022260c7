// SPDX-License-Identifier: GPL-2.0-or-later
// The legend of a plot: series that have a label, in their order, a sample and words each. In a
// box inside or right of the frame, or in lines below it. Called by plot_draw.
#ifndef AMONTONS_RENDER_PLOT_LEGEND_H
#define AMONTONS_RENDER_PLOT_LEGEND_H

#include "render/plot/plot.h"

typedef struct LegendSize {
    double width, height;   // of samples and words, pixels
    double margin;   // between them and the frame, pixels
    double clearance;   // data nearer than this to the words is in their way, pixels
    double mark;   // radius of the data's marks, pixels
} LegendSize;

// The legend's place in a corner of the frame, or for CORNER_OUTSIDE right of it at its top.
Box legend_box(const Axes *axes, const LegendSize *size, PlotCorner corner);

// Amount of data that a legend at `box` would hide: the length of the lines and error bars below
// it, and the width of the marks, pixels. By the length of drawn line a finely sampled curve weighs
// no more than a coarse one.
double legend_hides(const PlotPanel *panel, const Axes *axes, const LegendSize *size,
                    const Box *box);

// The corner in which the legend hides nothing, and touches nothing of `taken` (an inset; NULL:
// none), the first of the enum's order; where there is no such corner CORNER_OUTSIDE, or if that
// would leave the frame too little of its width, the corner in which it hides least.
PlotCorner legend_choose(const PlotPanel *panel, const Axes *axes, const LegendSize *size,
                         const Box *taken);

// Finds the legend's place: the file's, or where it hides nothing; an outer one narrows the frame.
// share: of the usual size of marks. taken: part of the frame that something else covers, NULL:
// none. A box without height: no legend here.
Box legend_settle(const Page *page, const PlotPanel *panel, double share, const Box *taken,
                  Axes *axes);
void legend_draw(const Page *page, const Axes *axes, const PlotPanel *panel, const Box *box,
                 double share);

// True if the legend stands in lines below all: the file says so, the plot has maps or panels, or
// beside or in `frame` it would take too much room.
bool legend_is_below(const Page *page, const Plot *plot, const Axes *frame);
// Pixels that these lines take over the room's width.
double legend_below_height(const Page *page, const PlotPanel *panel, const Box *room);
void legend_below_draw(const Page *page, const PlotPanel *panel, const Box *room);

#endif
