// SPDX-License-Identifier: GPL-2.0-or-later
// Measurements from a table of comma-separated values, to be drawn beside a result. Called by the
// figures.
//
// The first line names the columns, with units behind them; columns of other names are left alone
// (a `source`, a remark):
//
//     U (mm), F_T/F_N, error            # the load ratio against the rod's way, for `force`;
//     U/L, mu                          # mu is F_T/F_N; so are the columns F_T and F_N, of one unit
//     U (mm), x (cm), error             # how far slip has come, for `slip-map`
//
// `error` is what one reads or measures F_T/F_N, or x, to, in that unit.
#ifndef AMONTONS_RENDER_FIGURES_MEASURED_H
#define AMONTONS_RENDER_FIGURES_MEASURED_H

#include "render/figures/result_view.h"

enum { MEASURED_WORDS_SIZE = 200 };

typedef enum MeasuredKind { MEASURED_MU, MEASURED_X } MeasuredKind;

typedef struct Measured {
    int32_t count;
    double *U;   // [count] length of the result; owned, as the next two
    double *value;   // [count] 1, or length
    double *error;   // [count] NaN: not given
    char words[MEASURED_WORDS_SIZE];   // for a legend: the file's name and the misfit
} Measured;

// What the file says of `kind`; count 0: nothing, or no file is given (path NULL). The misfit is
// the root of the mean square of what is measured less what was computed at the same U, over the
// points that the history covers; in parts of the errors too where all have one. series:
// [view->rows].
bool measured_read(const char *path, MeasuredKind kind, const ResultView *view,
                   const double *series, Measured *measured, Error *err);
void measured_destroy(Measured *measured);   // zeroed is fine

#endif
