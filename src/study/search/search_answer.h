// SPDX-License-Identifier: GPL-2.0-or-later
// Writes what every search leaves beside its tables: the answer in words, the scene of the best
// design, and figures. Called by optimise_report, pareto_front and fit_report.
#ifndef AMONTONS_STUDY_SEARCH_SEARCH_ANSWER_H
#define AMONTONS_STUDY_SEARCH_SEARCH_ANSWER_H

#include "study/search/search.h"
#include "run/result/figure_file.h"
#include "study/sweep/showing/quantity_label.h"

// Text that is written to `out` between begin and end goes to options->out (NULL: nowhere) and to
// DIR/answer.txt.
typedef struct SearchAnswer {
    FILE *out;
    char *text;
    size_t size;
} SearchAnswer;

bool search_answer_begin(SearchAnswer *answer, Error *err);
bool search_answer_end(const Search *search, SearchAnswer *answer, Error *err);
// A line if there were no further designs to compute.
void search_print_exhausted(const Search *search, FILE *out);
// DIR/best.yaml, a scene to be run, of a design at a condition; figures/best.png: its mesh and rod.
bool search_leave_best(const Search *search, int32_t design, int32_t condition, Error *err);

enum { COLOR_BEST = 1, COLOR_DESIGNS = 0, COLOR_LINE = 7 };

// Axes of a figure, figures/NAME.png: curves over one axis.
typedef struct Frame {
    const char *name;   // of the file
    const char *x_scale, *y_scale;   // "linear", "log"
    QuantityLabel x, y;
} Frame;

// [count] curves, the last over the others.
bool search_draw(const Search *search, const Frame *frame, const Curve *curves, int32_t count,
                 Error *err);
Curve search_dots(const char *label, int32_t count, const double *x, const double *y);
Curve search_line(const char *label, int32_t count, const double *x, const double *y);
QuantityLabel search_key_label(const Search *search, int32_t k);   // of a key that is searched
const char *search_key_scale(const Search *search, int32_t k);   // "linear", "log"

#endif
