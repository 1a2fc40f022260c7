// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/figures/computed.h"

#include "base/memory.h"
#include "io/hdf5/result_tables.h"
#include "render/view/zoom.h"

#include <math.h>

enum { STATIONS = 21 };

static const double RAPID = 2;   // slip rate over V (record/events)
static const double MOST_SHOWN = 3;   // times the fastest wave: beyond it arrivals are one step's

static bool curve_make(ViewCurve *curve, int64_t most, Error *err)
{
    return (curve->at = NEW_ARRAY(double, most, err)) &&
           (curve->value = NEW_ARRAY(double, most, err));
}

static void curve_add(ViewCurve *curve, double at, double value)
{
    curve->at[curve->count] = at;
    curve->value[curve->count++] = value;
}

void computed_choose_cycle(ResultView *view, int32_t cycle)
{
    memory_free_all(view->precursors.at, view->precursors.value, view->front_speed.at,
                    view->front_speed.value);
    view->precursors = view->front_speed = (ViewCurve){0};
    view->cycle = cycle;
}

// --- length over load ----------------------------------------------------------------------------

// Finds the length from the trailing end to the farthest point that slip, slow or in a precursor,
// has come to since the sliding before, against the largest F_T/F_N since then.
static bool find_lengths(ResultView *view, Error *err)
{
    int64_t first = 0, end = view->rows;
    double least = INFINITY, mu = -INFINITY, length = 0, from = result_view_trailing_end(view);
    Zoom zoom = zoom_choose(view);
    if (view->precursors.at) return true;
    if (!result_view_read_front(view, err) || !curve_make(&view->precursors, view->rows, err))
        return false;

    // The rows of the cycle: from the shortest front behind the sliding before to the next one.
    for (int64_t row = 0; zoom.found && row < view->rows; ++row) {
        double U = view->U[row];
        if (U > zoom.U_slide) {
            end = row;
            break;
        }
        if (U >= zoom.U_start && view->front[row] <= least) {
            least = view->front[row];
            if (view->mu[row] <= view->mu[first] || first == 0) first = row;
        }
    }

    for (int64_t row = first; row < end; ++row) {
        if (!isfinite(view->mu[row] + view->front[row])) continue;
        mu = fmax(mu, view->mu[row]);
        length = fmax(length, view->front[row] - from);

        // The largest length of the precursors of the cycle that have begun.
        double longest = 0;
        for (int32_t k = 0; k < view->event_count; ++k) {
            const ViewEvent *event = &view->events[k];
            if (event->kind == VIEW_BOUNDED && event->U_start <= view->U[row] &&
                zoom_covers(&zoom, event->U_start))
                longest = fmax(longest, event->reach - from);
        }
        length = fmax(length, longest);
        curve_add(&view->precursors, mu, length);
    }
    return true;
}

bool computed_event(const ResultView *view, const ViewEvent *event, double *mu, double *length)
{
    int64_t before = 0, last = 0;
    Zoom zoom = zoom_choose(view);
    bool sliding = event->kind == VIEW_LEADING;
    if (!view_event_counts(event) || !isfinite(event->U_start + event->U_stop) ||
        !zoom_covers(&zoom, event->U_start))
        return false;
    result_view_event_rows(view, event->U_start, event->U_stop, &before, &last);
    *mu = view->mu[before];
    *length = sliding ? view->number[NUMBER_LENGTH] : event->reach - result_view_trailing_end(view);
    return isfinite(*mu) && *length > 0;
}

bool computed_events(const ResultView *view, ViewEventKind kind, ViewCurve *events, Error *err)
{
    *events = (ViewCurve){0};
    if (!curve_make(events, view->event_count, err)) return false;
    for (int32_t k = 0; k < view->event_count; ++k) {
        double mu = NAN, length = NAN;
        if (view->events[k].kind == (int32_t)kind &&
            computed_event(view, &view->events[k], &mu, &length))
            curve_add(events, mu, length);
    }
    return true;
}

// --- speed over place ----------------------------------------------------------------------------

// Distance between two stations, length.
static double station_step(const ResultView *view)
{
    return (view->x[view->nodes - 1] - view->x[0]) / (STATIONS - 1);
}

// At x; NaN in gaps between pads and where a neighbour was not reached.
static double arrival_at(const ResultView *view, const double *times, double x)
{
    for (int32_t i = 0; i + 1 < view->nodes; ++i) {
        double low = view->x[i], high = view->x[i + 1];
        if (!(x >= low && x <= high) || view->pad[i] != view->pad[i + 1]) continue;
        double part = high > low ? (x - low) / (high - low) : 0;
        return part > 0 ? times[i] + part * (times[i + 1] - times[i]) : times[i];
    }
    return NAN;
}

// Finds speeds between stations a twentieth of the block apart, by the times at which slip there
// first gets faster than twice the rod, as in record/events. Where slip was slow before the
// front is one of speeding up, and may run faster than any wave.
static bool find_speeds(ResultView *view, double start, double stop, ViewCurve *curve, Error *err)
{
    double *times = NULL, V = fabs(view->number[NUMBER_ROD_VELOCITY]);
    int64_t first = 0, last = 0;
    TRY(result_view_read_slip_rate(view, err));
    TRY(times = NEW_ARRAY(double, view->nodes, err));
    TRY(curve_make(curve, STATIONS, err));
    result_view_event_rows(view, start, stop, &first, &last);

    // Find when each node first slipped so fast, between steps by its slip rates; NaN: it did not.
    for (int32_t i = 0; i < view->nodes; ++i) {
        int64_t row = first;
        const double *rate = view->slip_rate + i;
        while (row <= last && !(fabs(rate[row * view->nodes]) >= RAPID * V)) ++row;
        times[i] = row > last ? NAN : view->t[row];
        if (row > last || row == 0) continue;
        double now = fabs(rate[row * view->nodes]), before = fabs(rate[(row - 1) * view->nodes]);
        double part = now > before ? fmin((RAPID * V - before) / (now - before), 1) : 1;
        times[i] -= (1 - fmax(part, 0)) * (view->t[row] - view->t[row - 1]);
    }

    double low = view->x[0], step = station_step(view);
    for (int32_t k = 0; k + 1 < STATIONS; ++k) {
        double took = arrival_at(view, times, low + (k + 1) * step) -
                      arrival_at(view, times, low + k * step);
        if (step / fabs(took) < MOST_SHOWN * view->number[NUMBER_C_LONGITUDINAL])
            curve_add(curve, low + (k + 0.5) * step, step / took);
    }
cleanup:
    memory_free(times);
    return error_is_clean(err);
}

bool computed_front_speed(ResultView *view, const ViewEvent *event, ViewCurve *curve, Error *err)
{
    *curve = (ViewCurve){0};
    return find_speeds(view, event->U_start, event->U_stop, curve, err);
}

bool computed_speeds_join(const ResultView *view, const ViewCurve *curve, int64_t k)
{
    return curve->at[k + 1] - curve->at[k] < 1.5 * station_step(view) &&
           curve->value[k] * curve->value[k + 1] > 0;
}

double computed_speed(const ResultView *view, const ViewCurve *curve, double x)
{
    for (int64_t k = 0; k + 1 < curve->count; ++k) {
        double from = curve->at[k], to = curve->at[k + 1];
        if (!(x >= from && x <= to) || !computed_speeds_join(view, curve, k)) continue;
        double part = (x - from) / (to - from);
        return fabs(curve->value[k] + part * (curve->value[k + 1] - curve->value[k]));
    }
    for (int64_t k = 0; k < curve->count; ++k)
        if (fabs(curve->at[k] - x) <= 0.5 * station_step(view)) return fabs(curve->value[k]);
    return NAN;
}

bool computed_curve(ResultView *view, MeasuredKind kind, ViewCurve *curve, Error *err)
{
    Zoom zoom = zoom_choose(view);
    double stop = INFINITY;
    *curve = (ViewCurve){0};
    switch (kind) {
    case MEASURED_MU:
        *curve = (ViewCurve){view->rows, view->U, view->mu};
        return true;
    case MEASURED_FRONT:
        if (!result_view_read_front(view, err)) return false;
        *curve = (ViewCurve){view->rows, view->U, view->front};
        return true;
    case MEASURED_LENGTH:
        if (!find_lengths(view, err)) return false;
        *curve = view->precursors;
        return true;
    case MEASURED_SPEED:   // that of the sliding of the cycle
        for (int32_t k = 0; k < view->event_count; ++k)
            if (view->events[k].U_start == zoom.U_slide) stop = view->events[k].U_stop;
        if (!view->front_speed.at && zoom.found &&
            !find_speeds(view, zoom.U_slide, stop, &view->front_speed, err))
            return false;
        *curve = view->front_speed;
        return true;
    default:
        return true;
    }
}

// --- area ----------------------------------------------------------------------------------------

bool computed_area_read(ResultView *view, Error *err)
{
    double critical = view->number[NUMBER_CRITICAL_VELOCITY];
    if (view->area) return true;
    if (result_file_has_series(view->file, SERIES_AREA))
        return result_view_read(view, SERIES_AREA, false, &view->area, err);
    if (!(critical > 0)) return REFUSE(err, FIGURE_NO_DENSITY);
    if (!result_view_read_slip_rate(view, err) || !result_view_read_status(view, err)) return false;
    int64_t count = view->rows * view->nodes;
    if (!(view->area = NEW_ARRAY(double, count, err))) return false;
    for (int64_t k = 0; k < count; ++k)
        view->area[k] = fmax(1 - fabs(view->slip_rate[k]) / critical, 0);
    return true;
}

// Contact area, over that at rest, of the node nearest to x at that row; open contact has none.
static double area_at(const ResultView *view, int64_t row, double x)
{
    int32_t nearest = 0;
    for (int32_t i = 1; i < view->nodes; ++i)
        if (fabs(view->x[i] - x) < fabs(view->x[nearest] - x)) nearest = i;
    int64_t k = row * view->nodes + nearest;
    return view->status[k] == STATUS_OPEN ? 0 : view->area[k];
}

double computed_area(const ResultView *view, double U, double x)
{
    double low = 0, high = 0;
    result_view_x_extent(view, &low, &high);
    if (x < low || x > high) return NAN;
    for (int64_t row = 0; row + 1 < view->rows; ++row) {
        double from = view->U[row], to = view->U[row + 1];
        if (!(U >= from && U <= to)) continue;
        double part = to > from ? (U - from) / (to - from) : 1, before = area_at(view, row, x);
        return before + part * (area_at(view, row + 1, x) - before);
    }
    return NAN;
}
