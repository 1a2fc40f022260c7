// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/plot/marks.h"

#include <math.h>

static const double THIN_WIDTH = 0.45;   // points
static const double RIM = 0.62;   // inside over outside of an open mark
static const double CROSS_ARM = 0.9, CROSS_WIDTH = 0.6;   // of the radius; points

// Any two are more than 25 apart in CIELAB, also for eyes without one of the three kinds of cones;
// 0 is ink.
static const Color COLORS[PLOT_COLORS] = {{0.08f, 0.08f, 0.10f, 1}, {0.00f, 0.29f, 0.76f, 1},
                                          {0.72f, 0.04f, 0.00f, 1}, {0.03f, 0.57f, 0.30f, 1},
                                          {0.47f, 0.19f, 0.48f, 1}, {0.78f, 0.68f, 0.10f, 1},
                                          {0.07f, 0.77f, 0.97f, 1}, {0.50f, 0.50f, 0.52f, 1}};

bool plot_bar_ends(const Axes *axes, const PlotSeries *series, int32_t k, Point end[2])
{
    bool lying = axes->y.names != NULL;
    if (!series->low || !series->high) return false;
    double low = series->low[k], high = series->high[k];
    end[0] = lying ? axes_place(axes, low, series->y[k]) : axes_place(axes, series->x[k], low);
    end[1] = lying ? axes_place(axes, high, series->y[k]) : axes_place(axes, series->x[k], high);
    return isfinite(end[0].x + end[0].y + end[1].x + end[1].y);
}

// Sizes are chosen so that circle, square and triangle cover the same area: none looks heavier.
static void marker_shape(Canvas *canvas, PlotMarker marker, Color color, Point at, double radius)
{
    const double side = 0.89 * radius;   // of equal area
    const double wide = 1.17 * radius, tall = 1.35 * radius, low = 0.68 * radius;
    const Point square[4] = {{at.x - side, at.y - side},
                             {at.x + side, at.y - side},
                             {at.x + side, at.y + side},
                             {at.x - side, at.y + side}};
    double up = marker == MARKER_DOWN ? -1 : 1;
    const Point triangle[3] = {
        {at.x, at.y - up * tall}, {at.x + wide, at.y + up * low}, {at.x - wide, at.y + up * low}};
    if (marker == MARKER_CIRCLE) draw_disc(canvas, color, at, radius);
    if (marker == MARKER_SQUARE) draw_polygon(canvas, color, square, 4);
    if (marker == MARKER_TRIANGLE || marker == MARKER_DOWN)
        draw_polygon(canvas, color, triangle, 3);
}

void cross_draw(const Page *page, Color color, Point at, double arm)
{
    Stroke stroke = {.color = color, .width = CROSS_WIDTH * page->point};
    draw_segment(page->canvas, &stroke, (Point){at.x - arm, at.y - arm},
                 (Point){at.x + arm, at.y + arm});
    draw_segment(page->canvas, &stroke, (Point){at.x - arm, at.y + arm},
                 (Point){at.x + arm, at.y - arm});
}

// An open mark is its filled shape with paper inside.
void mark_draw(const Page *page, const PlotSeries *series, Point at, double share)
{
    double radius = MARKER_RADIUS * share * page->point;
    if (series->marker == MARKER_NONE || !isfinite(at.x) || !isfinite(at.y)) return;
    if (series->marker == MARKER_CROSS) {
        cross_draw(page, COLORS[series->color], at, CROSS_ARM * radius);
        return;
    }
    marker_shape(page->canvas, series->marker, COLORS[series->color], at, radius);
    if (!series->filled) marker_shape(page->canvas, series->marker, PAPER, at, RIM * radius);
}

Stroke mark_stroke(const Page *page, const PlotSeries *series, double share)
{
    double width = series->line == LINE_SOLID ? CURVE_WIDTH : THIN_WIDTH;
    Stroke stroke = {.color = COLORS[series->color], .width = width * share * page->point};
    if (series->line == LINE_DASHED) {
        stroke.dash = 2.6 * page->point;
        stroke.space = 1.8 * page->point;
    }
    return stroke;
}

Color mark_color(const PlotSeries *series)
{
    return COLORS[series->color];
}
