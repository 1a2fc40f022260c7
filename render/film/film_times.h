// SPDX-License-Identifier: GPL-2.0-or-later
// The history between its steps, as a film needs it: U, mu and slip rates are linear in time from
// one accepted step to the next. Called by film and its parts.
#ifndef AMONTONS_RENDER_FILM_FILM_TIMES_H
#define AMONTONS_RENDER_FILM_FILM_TIMES_H

#include "render/view/result_view.h"

typedef struct FilmMoment {
    double t, U, mu;   // time, length, 1
    int64_t row;   // the step before, or at it
    double part;   // of the way to the next one, 0 to 1
} FilmMoment;

FilmMoment film_moment(const ResultView *view, double t);
// Value at that moment of column k of values [rows * width].
double film_value(const FilmMoment *moment, const double *values, int32_t width, int32_t k);
int64_t film_nearest_row(const FilmMoment *moment);

// A span has a beginning and an end ("U=0.0117", "t=120"; NULL: those of the run), or is a cycle
// ("first", "last", "3"): from the end of a bulk sliding to a little after the next one.
// ERROR_INPUT where there is no such time.
typedef struct FilmSpan {
    const char *from, *to;
    const char *cycle;   // NULL, "all": no
} FilmSpan;
bool film_span_find(const ResultView *view, const FilmSpan *span, double t[2], Error *err);

#endif
