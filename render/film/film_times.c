// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/film/film_times.h"

#include "render/view/block.h"
#include "render/view/zoom.h"

#include <math.h>
#include <stddef.h>

FilmMoment film_moment(const ResultView *view, double t)
{
    int64_t low = curve_place(view->t, view->rows, t), high = low + 1;
    double length = view->t[high] - view->t[low];
    double part = length > 0 ? fmin(fmax((t - view->t[low]) / length, 0), 1) : 1;
    return (FilmMoment){.t = t,
                        .U = view->U[low] + part * (view->U[high] - view->U[low]),
                        .mu = view->mu[low] + part * (view->mu[high] - view->mu[low]),
                        .row = low,
                        .part = part};
}

double film_value(const FilmMoment *moment, const double *values, int32_t width, int32_t k)
{
    const double *before = values + moment->row * width + k;
    return before[0] + moment->part * (before[width] - before[0]);
}

int64_t film_nearest_row(const FilmMoment *moment)
{
    return moment->part < 0.5 ? moment->row : moment->row + 1;
}

// The time at which the rod first comes to U.
static double time_of_U(const ResultView *view, double U)
{
    if (view->U[0] >= U) return view->t[0];
    for (int64_t row = 1; row < view->rows; ++row) {
        double before = view->U[row - 1], after = view->U[row];
        if (!(after >= U) || !(after > before)) continue;
        double part = fmin(fmax((U - before) / (after - before), 0), 1);
        return view->t[row - 1] + part * (view->t[row] - view->t[row - 1]);
    }
    return view->t[view->rows - 1];
}

static bool time_read(const ResultView *view, const char *at, double *t, Error *err)
{
    bool is_U = false;
    double value = 0;
    if (!block_moment_read(at, &is_U, &value, err)) return false;
    *t = is_U ? time_of_U(view, value) : value;
    return true;
}

bool film_span_find(const ResultView *view, const FilmSpan *span, double t[2], Error *err)
{
    double first = view->t[0], end = view->t[view->rows - 1];
    t[0] = first;
    t[1] = end;
    if (span->cycle) {
        ResultView asked = *view;
        if (!zoom_choose_cycle(&asked, span->cycle, err)) return false;
        if (asked.cycle != VIEW_CYCLE_ALL) {
            if (!zoom_sliding(&asked))
                return REFUSE(err, "no bulk sliding is in this history, so there is no cycle");
            Zoom zoom = zoom_choose(&asked);
            t[0] = time_of_U(view, zoom.U_start);
            t[1] = time_of_U(view, zoom.U_behind);
        }
    }
    if (span->from && !time_read(view, span->from, &t[0], err)) return false;
    if (span->to && !time_read(view, span->to, &t[1], err)) return false;
    t[0] = fmax(t[0], first);
    t[1] = fmin(t[1], end);
    if (!(t[1] > t[0]))
        return REFUSE(
            err,
            "nothing lies between the film's start and end: the history goes from U = %g, t = %g "
            "to U = %g, t = %g",
            view->U[0], first, view->U[view->rows - 1], end);
    return true;
}
