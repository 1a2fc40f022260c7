// SPDX-License-Identifier: GPL-2.0-or-later
// A figure of a search, figures/NAME.png: curves over one axis. Called by optimise_report, front
// and fit_figures.
#ifndef AMONTONS_STUDY_SEARCH_SEARCH_FIGURE_H
#define AMONTONS_STUDY_SEARCH_SEARCH_FIGURE_H

#include "study/search/search.h"
#include "study/sweep/showing/figure_file.h"

enum { COLOR_BEST = 1, COLOR_DESIGNS = 0, COLOR_LINE = 7 };

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
