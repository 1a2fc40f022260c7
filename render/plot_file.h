// SPDX-License-Identifier: GPL-2.0-or-later
// A plot described in a YAML (or JSON) file: curves, marks, error bars, levels. Studies write such
// files; `amontons render PLOT.yaml` draws them. Read here, drawn by figure_curves.
//
//     title: mu_M against pressure            # above the plot
//     height: 0.75                            # over the width; default 0.75
//     x: {label: "~{P}_{ext}", scale: log, range: [1e-3, 1e-1]}   # linear; the data's
//                                             # unit: Pa beside a label: written behind it, as
//                                             # kPa or MPa where that makes the numbers short
//     y: {label: "~{\u03bc}_{M}"}          # or {names: [a, b]}: these stand at y = 1, 2, ...
//     legend: auto                            # where it hides nothing; or upper-right, upper-left,
//                                             # lower-left, lower-right, outside, none
//     series:
//       - label: "~{L} = 1"                   # none: not in the legend
//         x: [0.001, 0.01]
//         y: [0.38, 0.24]                     # null: a gap
//         low: [0.37, 0.23]                   # with `high`: error bars, along x where y has names
//         high: [0.38, 0.25]
//         color: 1                            # of seven; 0: ink
//         marker: circle                      # or square, triangle, down, none
//         filled: false
//         line: thin                          # or solid, dashed, none
//     inset: {place: [0.5, 0.05, 0.97, 0.5], x: ..., y: ..., series: [...]}   # of the frame
#ifndef AMONTONS_RENDER_PLOT_FILE_H
#define AMONTONS_RENDER_PLOT_FILE_H

#include "render/axes.h"

enum { PLOT_SERIES_MAX = 32, PLOT_NAMES_MAX = 100, PLOT_COLORS = 8, PLOT_LABEL_SIZE = 96 };

typedef enum PlotMarker {
    MARKER_NONE,
    MARKER_CIRCLE,
    MARKER_SQUARE,
    MARKER_TRIANGLE,
    MARKER_DOWN,   // a triangle on its tip: points at something below
} PlotMarker;

typedef enum PlotLine { LINE_NONE, LINE_SOLID, LINE_THIN, LINE_DASHED } PlotLine;

typedef enum PlotCorner {
    CORNER_AUTO,   // render/legend_place.h chooses
    CORNER_NONE,
    CORNER_UPPER_RIGHT,
    CORNER_UPPER_LEFT,
    CORNER_LOWER_LEFT,
    CORNER_LOWER_RIGHT,
    CORNER_OUTSIDE,   // right of the frame, which makes room
} PlotCorner;

typedef struct PlotSeries {
    char label[PLOT_LABEL_SIZE];   // may be empty
    int32_t count;
    double *x, *y;   // [count] NaN: a gap; owned
    double *low, *high;   // [count] or NULL; owned
    int32_t color;
    PlotMarker marker;
    bool filled;
    PlotLine line;
} PlotSeries;

typedef struct PlotPanel {
    Axis x, y;   // ends fit the data where the file gives none
    char (*names)[AXIS_LABEL_SIZE];   // of y.names; owned
    PlotCorner legend;
    int32_t series_count;
    PlotSeries series[PLOT_SERIES_MAX];
} PlotPanel;

typedef struct Plot {
    char title[256];
    double height_over_width;
    PlotPanel main;
    bool has_inset;
    PlotPanel inset;
    double place[4];   // of the inset in the frame: left, top, right, bottom; 0 to 1
} Plot;

// ERROR_INPUT gives file:line:column, the key and what is allowed.
bool plot_file_read(const char *path, Plot *plot, Error *err);
void plot_destroy(Plot *plot);   // zeroed is fine

// Where the error bar of point k begins and ends on the picture: upright, or lying where the y axis
// has names. false: it has none, or one that the axes cannot show.
bool plot_bar_ends(const Axes *axes, const PlotSeries *series, int32_t k, Point end[2]);

#endif
