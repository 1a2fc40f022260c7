// SPDX-License-Identifier: GPL-2.0-or-later
// Axes and curves as SVG elements inside of a page, which styles them (classes axis, number, label,
// and the curves' own): so they follow its light and dark. Called by frames and page_figures.
#ifndef AMONTONS_RENDER_CANVAS_SVG_CHART_H
#define AMONTONS_RENDER_CANVAS_SVG_CHART_H

#include "io/text/html_writer.h"
#include "render/canvas/axes.h"

// Text with render/canvas/text's marks, as <i>, <sub>, <sup>.
void html_words(TextWriter *html, const char *words);

// Frame, ticks and names in the units of the drawing; without a name and numbers of x where others
// stand below.
void svg_axes(TextWriter *html, const Axes *axes, bool with_x);

// A curve through the points that lie in the frame's range of x; NaN is a gap. `class` is ours.
void svg_curve(TextWriter *html, const Axes *axes, const char *class, const double *x,
               const double *y, int64_t count);

// A line across the frame at y, with a name behind it; none where y is outside.
void svg_level(TextWriter *html, const Axes *axes, double y, const char *name);

#endif
