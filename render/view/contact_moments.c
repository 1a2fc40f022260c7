// SPDX-License-Identifier: GPL-2.0-or-later
// Slip is rapid from twice the rod's velocity on, as in the events of a run, and slip at all from a
// hundredth of it on, as in the slip map. Moments are those at which it had come to equal parts of
// the contact: what spreads is seen spreading, however unevenly steps lie.
#include "render/view/contact_moments.h"

#include "base/memory.h"
#include "base/order.h"
#include "render/view/block.h"
#include "render/view/zoom.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { SLOW_PARTS = 3, RAPID_PARTS = 2, MOMENT_SIZE = 64 };

static const double RAPID = 2, SLIPS = 0.01;   // of the rod's velocity
static const double ROUNDING = 1e-9;   // of sums of areas

// The event is the rapid one nearest to what is asked for; without a wish the sliding of the cycle
// that is asked for, else the last that carried the whole block, or else the last.
static bool take_event(const ResultView *view, const char *at, ContactMoments *moments, Error *err)
{
    bool by_U = true;
    double wanted = 0;
    if (at) {
        if (!block_moment_seen(view, at, &by_U, &wanted, err)) return false;
        if (!by_U) wanted = view->U[result_view_nearest_row(view, view->t, wanted)];
    }
    const ViewEvent *event = at ? NULL : zoom_sliding(view);
    if (event && !isfinite(event->U_stop)) event = NULL;
    bool chosen = event != NULL;
    double least = INFINITY;
    for (int32_t k = 0; k < view->event_count && !chosen; ++k) {
        const ViewEvent *seen = &view->events[k];
        if (seen->kind <= VIEW_QUASI_STATIC || !isfinite(seen->U_start + seen->U_stop)) continue;
        double away = at ? fabs(seen->U_start - wanted) : seen->kind == VIEW_LEADING ? 0 : 1;
        if (!(away <= least)) continue;
        least = away;
        event = seen;
    }
    if (!event)
        return REFUSE(err,
                      "no rapid slip has been seen from start to end: say when, as --at U=%.4g",
                      view->U[view->rows / 2]);
    moments->first = result_view_nearest_row(view, view->U, event->U_start);
    moments->last = result_view_nearest_row(view, view->U, event->U_stop);
    while (moments->first > 0 && view->U[moments->first] >= event->U_start) --moments->first;
    for (int32_t k = 0; k < view->rapid_count; ++k)
        if (view->rapid[k][1] < event->U_start)
            moments->before = result_view_nearest_row(view, view->U, view->rapid[k][1]);
    return true;
}

// Area of the contact that rapid slip had come to at a step.
static double area_reached(const ResultView *view, const ContactPlane *plane,
                           const ContactMoments *moments, int64_t row)
{
    double area = 0;
    for (int32_t i = 0; i < plane->nodes; ++i)
        if (moments->arrival[i] <= view->t[row] - moments->start) area += plane->weight[i];
    return area;
}

// Each row once; they come in order but for the last.
static void add_row(ContactMoments *moments, int64_t row)
{
    if (moments->count == 0 || row > moments->row[moments->count - 1])
        moments->row[moments->count++] = row;
}

// Area of the contact that slips at a step.
static double area_slipping(const ResultView *view, const ContactPlane *plane, const double *rates,
                            int64_t row)
{
    double area = 0, least = SLIPS * fabs(view->number[NUMBER_ROD_VELOCITY]);
    for (int32_t i = 0; i < plane->nodes; ++i)
        if (rates[row * plane->nodes + i] >= least) area += plane->weight[i];
    return area;
}

bool contact_moments_find(const ResultView *view, const double *rates, const char *at, bool whole,
                          ContactMoments *moments, Error *err)
{
    const ContactPlane *plane = &view->plane;
    int32_t nodes = plane->nodes;
    *moments = (ContactMoments){0};

    // The moments that are asked for, in the order of time.
    if (at && !whole) {
        char word[MOMENT_SIZE];
        for (; *at; at += strcspn(at, ","), at += *at == ',') {
            bool by_U = false;
            double value = 0;
            if (moments->count == MOMENTS_MAX)
                return REFUSE(err, "a figure shows %d moments at most", MOMENTS_MAX);
            snprintf(word, sizeof word, "%.*s", (int)strcspn(at, ","), at);
            if (!block_moment_seen(view, word, &by_U, &value, err)) return false;
            moments->row[moments->count++] =
                result_view_nearest_row(view, by_U ? view->U : view->t, value);
        }
        qsort(moments->row, (size_t)moments->count, sizeof *moments->row, order_int64);
        moments->asked = true;
        moments->first = moments->row[0];
        moments->last = moments->row[moments->count - 1];
        return true;
    }
    if (!take_event(view, at, moments, err)) return false;

    // Time when each node was first rapid in the event, counted from the first of them.
    double rapid_rate = RAPID * fabs(view->number[NUMBER_ROD_VELOCITY]);
    double *arrival = moments->arrival = NEW_ARRAY(double, nodes, err);
    if (!arrival) return false;
    moments->start = INFINITY;
    for (int32_t i = 0; i < nodes; ++i) {
        int64_t row = moments->first;
        while (row <= moments->last && !(rates[row * nodes + i] >= rapid_rate)) ++row;
        arrival[i] = row <= moments->last ? view->t[row] : NAN;
        moments->start = fmin(moments->start, arrival[i]);
    }
    for (int32_t i = 0; i < nodes; ++i) arrival[i] -= moments->start;

    // Two moments while slow slip grows. Between the events it begins anew where less than the
    // first part slips.
    double all = 0, rapid = area_reached(view, plane, moments, moments->last);
    int64_t row = moments->before;
    for (int32_t i = 0; i < nodes; ++i) all += plane->weight[i];
    while (row < moments->first && area_slipping(view, plane, rates, row) > all / SLOW_PARTS) ++row;
    for (int32_t part = 1; part < SLOW_PARTS; ++part) {
        double wanted = (double)part / SLOW_PARTS * all;
        while (row < moments->first && area_slipping(view, plane, rates, row) < wanted) ++row;
        if (row < moments->first) add_row(moments, row);
    }

    // The step before the event, and when rapid slip had come to half and to all that it reached.
    add_row(moments, moments->first);
    row = moments->first;
    for (int32_t part = 1; part <= RAPID_PARTS; ++part) {
        double wanted = (double)part / RAPID_PARTS * (1 - ROUNDING) * rapid;
        while (row < moments->last && area_reached(view, plane, moments, row) < wanted) ++row;
        add_row(moments, row);
    }

    // The step in which the contact is fastest in the mean.
    double most = -INFINITY;
    int64_t fastest = moments->first;
    for (int64_t k = moments->first; k <= moments->last; ++k) {
        double sum = 0;
        for (int32_t i = 0; i < nodes; ++i) sum += plane->weight[i] * rates[k * nodes + i];
        if (sum > most) fastest = k;
        most = fmax(most, sum);
    }
    add_row(moments, fastest);
    return true;
}

void contact_moments_destroy(ContactMoments *moments)
{
    memory_free(moments->arrival);
    *moments = (ContactMoments){0};
}
