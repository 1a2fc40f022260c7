// SPDX-License-Identifier: GPL-2.0-or-later
// A figure of a sweep: first a description in render/plot_file's format, figures/NAME.json, which a
// user may edit and draw again (`amontons render`); the module `render` makes the picture. Called
// by figures.
#ifndef AMONTONS_STUDY_SWEEP_FIGURE_FILE_H
#define AMONTONS_STUDY_SWEEP_FIGURE_FILE_H

#include "io/json_writer.h"
#include "study/sweep/table.h"

enum { FIGURE_LABEL_SIZE = 90 };

typedef struct Figure {
    const Sweep *sweep;
    const char *name;   // "ranking"
    JsonWriter *json;
    Scene *scene;   // of one point; owned
} Figure;

// Points to draw: [count] each. NaN in `error` draws no bar, NaN in `y` no point.
typedef struct Curve {
    const char *label, *line;
    int32_t color, count;
    bool marked, filled;
    const double *x, *y;
    const double *error;   // of the value: y, or x where the y axis has names; NULL: no bars
    bool lying;   // the value is x
} Curve;

// Opens figures/NAME.json, and takes the first point's scene for its units.
bool figure_begin(Figure *figure, Error *err);
// The description on disk, then its picture. Called once, also after a failure.
bool figure_end(Figure *figure, Error *err);
typedef struct FigureLabel {
    char words[FIGURE_LABEL_SIZE];
    const char *unit;   // of SI, to be written with the prefix that suits; NULL: none
} FigureLabel;
// Its ends fit the data.
void figure_write_axis(Figure *figure, const char *name, const FigureLabel *label, bool is_log);
void figure_write_curve(JsonWriter *json, const Curve *curve);

// Why the marks of a point are open: a bit for each kind of its warnings, and one more where its
// error should be known and is not. 0: they are not.
uint32_t figure_doubts(const SweepTable *table, int32_t point, bool has_error, double error);
// Curves without a point, which name doubts about open marks in the legend: as many as the format
// has room for beside 15 curves of two.
void figure_write_doubts(Figure *figure, const Warned *warned, uint32_t doubts);

const char *figure_last_word(const char *key);   // "length" of mesh.set.length
// The paper's symbol where there is one, with render/text's marks.
FigureLabel figure_record_label(const StudyRecord *record);
// "pressure" and "Pa", or "pressure / E" in normalised units.
FigureLabel figure_key_label(const char *name, const Scene *scene);

#endif
