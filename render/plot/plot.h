// SPDX-License-Identifier: GPL-2.0-or-later
// A plot: curves, marks, error bars, levels, maps. Read by plot_file, drawn by plot_draw and
// plot_map.
#ifndef AMONTONS_RENDER_PLOT_PLOT_H
#define AMONTONS_RENDER_PLOT_PLOT_H

#include "render/canvas/axes.h"

enum {
    PLOT_SERIES_MAX = 32,
    PLOT_PANELS_MAX = 24,
    PLOT_NAMES_MAX = 100,
    PLOT_COLORS = 8,
    PLOT_LABEL_SIZE = 96,
    PLOT_WORDS = 16,
    PLOT_WORD_SIZE = 1024,
};

typedef enum PlotMarker {
    MARKER_NONE,
    MARKER_CIRCLE,
    MARKER_SQUARE,
    MARKER_TRIANGLE,
    MARKER_DOWN,   // a triangle on its tip: points at something below
    MARKER_CROSS,
} PlotMarker;

typedef enum PlotLine { LINE_NONE, LINE_SOLID, LINE_THIN, LINE_DASHED } PlotLine;

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

// Points and what was found there, shown in colours.
typedef struct PlotMap {
    int32_t count;
    double *x, *y, *value;   // [count] owned, as the next two; value NaN: no answer
    double
        *contour;   // [count] or NULL: lines at equal values of this, where the points form a grid
    double *open;   // [count] or NULL: 1 where the point's mark is open, 2: a square
} PlotMap;

typedef struct PlotPanel {
    char title[PLOT_LABEL_SIZE];   // of one among several; may be empty
    Axis x, y;   // ends fit the data where the file gives none
    char (*names)[AXIS_LABEL_SIZE];   // of y.names; owned
    int32_t series_count;
    PlotSeries series[PLOT_SERIES_MAX];
    bool has_map;
    PlotMap map;   // below the series
} PlotPanel;

typedef struct Plot {
    char title[256];
    bool no_legend;   // the file says `legend: none`, or the page does
    double height_over_width;
    PictureStyle style;   // what its `page` says; texts in `words`
    char words[PLOT_WORDS][PLOT_WORD_SIZE];   // [word_count]
    char measured[PLOT_LABEL_SIZE];   // name of the measurements in the legend; empty: their file's
    const char *left_out;   // measurements that the plot must not read, among `words`; NULL: none
    int32_t word_count;
    char column[2][PLOT_LABEL_SIZE];   // of a table of measurements: those of x and y; may be empty
    PlotPanel main;
    int32_t panel_count;   // 0: `main` is the plot; else it is drawn in each of these
    PlotPanel *panels;   // [panel_count] their axes are main's; owned
    Axis color, contours;   // of maps: value, and what the lines show; ends fit, as above
    double found[2];   // least and largest value of the maps
    bool has_inset;
    PlotPanel inset;
    double *computed;   // [count] at main's last series, which is measured; NULL: nothing is; owned
    double place[4];   // of the inset in the frame: left, top, right, bottom; 0 to 1
} Plot;

#endif
