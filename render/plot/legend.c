// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/plot/legend.h"

#include "render/plot/marks.h"

#include <math.h>

static const double FRAME_LEFT_MIN = 0.4;   // of the frame's width, beside an outer legend
static const double LEGEND_SAMPLE = 14, LEGEND_GAP = 3, LEGEND_MARGIN = 4;   // points
static const double LEGEND_CLEARANCE = 2;   // points: words to data
static const double LEGEND_PITCH = 1.5;   // line to line, over the size of the words
static const double FRAME_LEAST = 0.6;   // of its width that a legend beside it leaves
static const double LEGEND_SPACE = 8;   // points between entries of one line

// --- where it hides least -----------------------------------------------------------------------

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

// Segments are cut to the box by their parameter (Liang and Barsky's clipping, ACM Trans. Graph. 3,
// 1, 1984).
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

PlotCorner legend_choose(const PlotPanel *panel, const Axes *axes, const LegendSize *size,
                         const Box *taken)
{
    PlotCorner best = CORNER_UPPER_RIGHT;
    double least = INFINITY, width = axes->box.right - axes->box.left;
    for (PlotCorner corner = CORNER_UPPER_RIGHT; corner <= CORNER_LOWER_RIGHT; ++corner) {
        Box box = legend_box(axes, size, corner);
        if (taken && box.left < taken->right && taken->left < box.right &&
            box.top < taken->bottom && taken->top < box.bottom)
            continue;
        double hidden = legend_hides(panel, axes, size, &box);
        if (hidden < least) best = corner;
        least = fmin(least, hidden);
    }
    bool has_room = width - size->width - size->margin >= FRAME_LEFT_MIN * width;
    return least > 0 && has_room ? CORNER_OUTSIDE : best;
}

// --- in or beside the frame ---------------------------------------------------------------------

// Size of the legend of the labelled series; height 0: there is no legend.
static LegendSize legend_measure(const Page *page, const Axes *axes, const PlotPanel *panel,
                                 double share)
{
    double font = axes_number_size(axes) * page->point, widest = 0;
    LegendSize size = {.margin = LEGEND_MARGIN * page->point,
                       .clearance = LEGEND_CLEARANCE * page->point,
                       .mark = MARKER_RADIUS * share * page->point};
    if (panel->legend == CORNER_NONE || panel->legend == CORNER_BELOW) return size;
    for (int32_t k = 0; k < panel->series_count; ++k) {
        if (!panel->series[k].label[0]) continue;
        widest = fmax(widest, text_width(page->text, font, panel->series[k].label));
        size.height += LEGEND_PITCH * font;
    }
    size.width = widest + (LEGEND_SAMPLE + LEGEND_GAP) * page->point;
    return size;
}

Box legend_settle(const Page *page, const PlotPanel *panel, double share, const Box *taken,
                  Axes *axes)
{
    LegendSize size = legend_measure(page, axes, panel, share);
    PlotCorner corner = panel->legend;
    if (!(size.height > 0)) return (Box){0};
    if (corner == CORNER_AUTO) corner = legend_choose(panel, axes, &size, taken);
    if (corner == CORNER_OUTSIDE)
        axes->box.right = round(axes->box.right - size.width - size.margin);
    return legend_box(axes, &size, corner);
}

// One entry from `at`, the left end of its middle line.
static void entry_draw(const Page *page, const PlotSeries *series, Point at, double font,
                       double share)
{
    TextStyle style = {.size = font, .color = INK, .up = 0.5};
    Stroke stroke = mark_stroke(page, series, share);
    double sample = LEGEND_SAMPLE * page->point, gap = LEGEND_GAP * page->point;
    if (series->line != LINE_NONE)
        draw_segment(page->canvas, &stroke, at, (Point){at.x + sample, at.y});
    mark_draw(page, series, (Point){at.x + sample / 2, at.y}, share);
    text_draw(page->text, &style, (Point){at.x + sample + gap, at.y}, series->label);
}

void legend_draw(const Page *page, const Axes *axes, const PlotPanel *panel, const Box *box,
                 double share)
{
    double font = axes_number_size(axes) * page->point;
    double pitch = LEGEND_PITCH * font, y = box->top + pitch / 2;
    if (!(box->bottom > box->top)) return;
    for (int32_t k = 0; k < panel->series_count; ++k) {
        const PlotSeries *series = &panel->series[k];
        if (!series->label[0]) continue;
        entry_draw(page, series, (Point){box->left, y}, font, share);
        y += pitch;
    }
}

// --- below --------------------------------------------------------------------------------------

bool legend_is_below(const Page *page, const Plot *plot, const Axes *frame)
{
    const PlotPanel *panel = &plot->main;
    if (panel->legend != CORNER_AUTO) return panel->legend == CORNER_BELOW;
    if (panel->has_map || plot->panel_count > 0) return true;
    LegendSize size = legend_measure(page, frame, panel, 1);
    if (plot->has_inset || !(size.height > 0)) return false;
    PlotCorner corner = legend_choose(panel, frame, &size, NULL);
    Box box = legend_box(frame, &size, corner);
    double width = frame->box.right - frame->box.left;
    if (corner == CORNER_OUTSIDE) return width - size.width - size.margin < FRAME_LEAST * width;
    return legend_hides(panel, frame, &size, &box) > 0;
}

// Goes from the room's top down, line by line. Returns the height of all.
static double below_walk(const Page *page, const PlotPanel *panel, const Box *room, bool draws)
{
    double font = NUMBER_SIZE * page->point, pitch = LEGEND_PITCH * font;
    double beside = (LEGEND_SAMPLE + LEGEND_GAP) * page->point, x = room->left, y = room->top;
    int32_t count = 0;
    for (int32_t k = 0; k < panel->series_count; ++k) {
        const PlotSeries *series = &panel->series[k];
        if (!series->label[0]) continue;
        double width = beside + text_width(page->text, font, series->label);
        if (count++ > 0 && x + width > room->right) {
            x = room->left;
            y += pitch;
        }
        if (draws) entry_draw(page, series, (Point){x, y + pitch / 2}, font, 1);
        x += width + LEGEND_SPACE * page->point;
    }
    return count > 0 ? y + pitch - room->top : 0;
}

double legend_below_height(const Page *page, const PlotPanel *panel, const Box *room)
{
    return below_walk(page, panel, room, false);
}

void legend_below_draw(const Page *page, const PlotPanel *panel, const Box *room)
{
    below_walk(page, panel, room, true);
}
