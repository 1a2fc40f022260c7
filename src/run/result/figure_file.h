// SPDX-License-Identifier: GPL-2.0-or-later
// A figure of curves or maps: first a description in render/plot/plot_file's format,
// figures/NAME.json, which a user may edit and draw again (`amontons render`); the module `render`
// makes the picture. Arrays too long for a text stand beside it in figures/NAME.h5. Called by
// run/accuracy_figure and the studies, in part by run/info/info_curves.
#ifndef AMONTONS_RUN_RESULT_FIGURE_FILE_H
#define AMONTONS_RUN_RESULT_FIGURE_FILE_H

#include "amontons.h"
#include "io/hdf5/array_file.h"
#include "io/text/json_writer.h"

typedef struct Figure {
    const char *folder;   // of the result; NULL: all stands in the text, and `json` is the caller's
    const char *name, *title;   // "ranking"; of the study
    const PictureStyle *style;   // NULL: the usual one
    const char *compare;   // a table of measurements, from the working folder; NULL: none
    JsonWriter *json;
    ArrayFile *arrays;   // owned; NULL: all stands in the text
    int32_t written, stored;   // numbers in the text; arrays in the file
} Figure;

// Points to draw: [count] each. NaN in `error` draws no bar, NaN in `y` no point.
typedef struct Curve {
    const char *label, *line;
    const char *marker;   // NULL: none
    int32_t color, count;
    bool filled;
    const double *x, *y;
    const double *error;   // of the value: y, or x where the y axis has names; NULL: no bars
    bool lying;   // the value is x
} Curve;

// Opens figures/NAME.json; folder, name and title are given.
bool figure_begin(Figure *figure, Error *err);
// The description on disk, then its picture. Called once, also after a failure.
bool figure_end(Figure *figure, Error *err);
// Its ends fit the data. unit: of SI, to be written with the prefix that suits; column: what tables
// of measurements call it; scale: "linear" or "log". NULL: it has none of these.
void figure_write_axis(Figure *figure, const char *name, const char *words, const char *unit,
                       const char *column, const char *scale);
bool figure_write_numbers(Figure *figure, const char *key, const double *values, int32_t count,
                          Error *err);
bool figure_write_curve(Figure *figure, const Curve *curve, Error *err);
// A curve without a point: its words and its sample stand in the legend.
bool figure_write_entry(Figure *figure, const Curve *curve, Error *err);
// Writes the legend's entries for doubtful points; doubts: bits. Points whose runs have warnings
// have open marks. A point whose error is not known has a mark without a bar, in a map a square.
enum { DOUBT_WARNED = 1, DOUBT_NO_ERROR = 2 };
bool figure_write_doubts(Figure *figure, int32_t doubts, bool map, Error *err);

#endif
