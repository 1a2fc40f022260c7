// SPDX-License-Identifier: GPL-2.0-or-later
// Each corner is weighed by the length of drawn line below the legend, so that a finely sampled
// curve weighs no more than a coarse one: segments are cut to the box by their parameter (Liang and
// Barsky's clipping, ACM Trans. Graph. 3, 1, 1984).
#include "render/plot/legend_place.h"

#include <math.h>

static const double FRAME_LEFT_MIN = 0.4;   // of the frame's width, beside an outer legend

Box legend_box(const Axes *axes, const LegendSize *size, PlotCorner corner)
{
    const Box *frame = &axes->box;
    bool right = corner == CORNER_UPPER_RIGHT || corner == CORNER_LOWER_RIGHT;
    bool lower = corner == CORNER_LOWER_LEFT || corner == CORNER_LOWER_RIGHT;
    Box box = {.left = frame->left + size->margin, .top = frame->top + size->margin};
    if (right) box.left = frame->right - size->margin - size->width;
    if (corner == CORNER_OUTSIDE) box.left = frame->right + size->margin;
    if (lower) box.top = frame->bottom - size->margin - size->height;
    box.right = box.left + size->width;
    box.bottom = box.top + size->height;
    return box;
}

static Box grown(const Box *box, double by)
{
    return (Box){box->left - by, box->top - by, box->right + by, box->bottom + by};
}

// Narrows the part [*low, *high] of a segment, 0 its start and 1 its end, to where `start` + part *
// `way` lies between `from` and `to`.
static void cut(double start, double way, double from, double to, double *low, double *high)
{
    if (way == 0) {
        if (start < from || start > to) *high = -1;
        return;
    }
    double first = (from - start) / way, last = (to - start) / way;
    *low = fmax(*low, fmin(first, last));
    *high = fmin(*high, fmax(first, last));
}

// Length of the segment from a to b inside the box; 0 where an end is not finite.
static double length_inside(Point a, Point b, const Box *box)
{
    double low = 0, high = 1;
    if (!isfinite(a.x + a.y + b.x + b.y)) return 0;
    cut(a.x, b.x - a.x, box->left, box->right, &low, &high);
    cut(a.y, b.y - a.y, box->top, box->bottom, &low, &high);
    return high > low ? (high - low) * hypot(b.x - a.x, b.y - a.y) : 0;
}

double legend_hides(const PlotPanel *panel, const Axes *axes, const LegendSize *size,
                    const Box *box)
{
    Box near = grown(box, size->clearance), marks = grown(box, size->clearance + size->mark);
    double hidden = 0;
    for (int32_t s = 0; s < panel->series_count; ++s) {
        const PlotSeries *series = &panel->series[s];
        Point before = {NAN, NAN}, bar[2];
        for (int32_t k = 0; k < series->count; ++k) {
            Point at = axes_place(axes, series->x[k], series->y[k]);
            bool below = at.x > marks.left && at.x < marks.right && at.y > marks.top &&
                         at.y < marks.bottom;
            if (series->marker != MARKER_NONE && below) hidden += 2 * size->mark;
            if (series->line != LINE_NONE) hidden += length_inside(before, at, &near);
            if (plot_bar_ends(axes, series, k, bar)) hidden += length_inside(bar[0], bar[1], &near);
            before = at;
        }
    }
    return hidden;
}

static bool boxes_meet(const Box *a, const Box *b)
{
    return a->left < b->right && b->left < a->right && a->top < b->bottom && b->top < a->bottom;
}

PlotCorner legend_choose(const PlotPanel *panel, const Axes *axes, const LegendSize *size,
                         const Box *taken)
{
    PlotCorner best = CORNER_UPPER_RIGHT;
    double least = INFINITY, width = axes->box.right - axes->box.left;
    for (PlotCorner corner = CORNER_UPPER_RIGHT; corner <= CORNER_LOWER_RIGHT; ++corner) {
        Box box = legend_box(axes, size, corner);
        if (taken && boxes_meet(&box, taken)) continue;
        double hidden = legend_hides(panel, axes, size, &box);
        if (hidden < least) best = corner;
        least = fmin(least, hidden);
    }
    bool has_room = width - size->width - size->margin >= FRAME_LEFT_MIN * width;
    return least > 0 && has_room ? CORNER_OUTSIDE : best;
}
