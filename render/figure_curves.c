// SPDX-License-Identifier: GPL-2.0-or-later
// Lines below, then error bars, then marks; the legend where the file or legend_place puts it.
#include "render/figure_curves.h"

#include "base/memory.h"
#include "render/legend_place.h"

#include <math.h>

static const double MARKER_RADIUS = 1.9;   // points
static const double THIN_WIDTH = 0.45;   // points
static const double BAR_WIDTH = 0.5, BAR_CAP = 1.4;   // points: error bars, half their caps
static const double RIM = 0.62;   // inside over outside of an open mark
static const double LEGEND_SAMPLE = 14, LEGEND_GAP = 3, LEGEND_MARGIN = 4;   // points
static const double LEGEND_CLEARANCE = 2;   // points: words to data
static const double LEGEND_PITCH = 1.5;   // line to line, over the size of the words
static const double RIGHT_MARGIN = 6;   // points: half a number may stand there
static const double INSET_SHARE = 0.75;   // marks and lines of an inset over the main ones

// Told apart by most colour-blind readers and, by lightness, in grey print; 0 is ink.
static const Color COLORS[PLOT_COLORS] = {{0.08f, 0.08f, 0.10f, 1}, {0.00f, 0.35f, 0.66f, 1},
                                          {0.80f, 0.28f, 0.02f, 1}, {0.00f, 0.52f, 0.38f, 1},
                                          {0.55f, 0.20f, 0.55f, 1}, {0.72f, 0.55f, 0.00f, 1},
                                          {0.30f, 0.62f, 0.85f, 1}, {0.50f, 0.50f, 0.52f, 1}};

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
    if (marker == MARKER_CIRCLE) shape_disc(canvas, color, at, radius);
    if (marker == MARKER_SQUARE) shape_polygon(canvas, color, square, 4);
    if (marker == MARKER_TRIANGLE || marker == MARKER_DOWN)
        shape_polygon(canvas, color, triangle, 3);
}

// share: of the usual size, less in an inset. An open mark is its filled shape with paper inside.
static void marker_draw(const Page *page, const PlotSeries *series, Point at, double share)
{
    double radius = MARKER_RADIUS * share * page->point;
    if (series->marker == MARKER_NONE || !isfinite(at.x) || !isfinite(at.y)) return;
    marker_shape(page->canvas, series->marker, COLORS[series->color], at, radius);
    if (!series->filled) marker_shape(page->canvas, series->marker, PAPER, at, RIM * radius);
}

// share: of the usual width.
static Stroke line_stroke(const Page *page, const PlotSeries *series, double share)
{
    double width = series->line == LINE_SOLID ? CURVE_WIDTH : THIN_WIDTH;
    Stroke stroke = {.color = COLORS[series->color], .width = width * share * page->point};
    if (series->line == LINE_DASHED) {
        stroke.dash = 2.6 * page->point;
        stroke.space = 1.8 * page->point;
    }
    return stroke;
}

// A NaN breaks the line; so does what a logarithmic axis cannot show.
static bool line_draw(const Page *page, const Axes *axes, const PlotSeries *series, double share,
                      Error *err)
{
    Stroke stroke = line_stroke(page, series, share);
    Point *line = NULL;
    if (series->line == LINE_NONE) return true;
    TRY((line = NEW_ARRAY(Point, series->count, err)));
    for (int32_t k = 0; k < series->count; ++k)
        line[k] = axes_place(axes, series->x[k], series->y[k]);
    shape_line(page->canvas, &stroke, line, series->count);
cleanup:
    memory_free(line);
    return error_is_clean(err);
}

// From low to high with caps: upright, or lying where the y axis has names.
static void bars_draw(const Page *page, const Axes *axes, const PlotSeries *series)
{
    Stroke stroke = {.color = COLORS[series->color], .width = BAR_WIDTH * page->point};
    bool lying = axes->y.names != NULL;
    double cap_x = lying ? 0 : BAR_CAP * page->point, cap_y = lying ? BAR_CAP * page->point : 0;
    for (int32_t k = 0; k < series->count; ++k) {
        Point end[2];
        if (!plot_bar_ends(axes, series, k, end)) continue;
        shape_segment(page->canvas, &stroke, end[0], end[1]);
        for (int32_t side = 0; side < 2; ++side)
            shape_segment(page->canvas, &stroke, (Point){end[side].x - cap_x, end[side].y - cap_y},
                          (Point){end[side].x + cap_x, end[side].y + cap_y});
    }
}

// What the labelled series take; height 0: there is no legend.
static LegendSize legend_measure(const Page *page, const Axes *axes, const PlotPanel *panel,
                                 double share)
{
    double font = axes->number_size * page->point, widest = 0;
    LegendSize size = {.margin = LEGEND_MARGIN * page->point,
                       .clearance = LEGEND_CLEARANCE * page->point,
                       .mark = MARKER_RADIUS * share * page->point};
    if (panel->legend == CORNER_NONE) return size;
    for (int32_t k = 0; k < panel->series_count; ++k) {
        if (!panel->series[k].label[0]) continue;
        widest = fmax(widest, text_width(page->text, font, panel->series[k].label));
        size.height += LEGEND_PITCH * font;
    }
    size.width = widest + (LEGEND_SAMPLE + LEGEND_GAP) * page->point;
    return size;
}

// Finds the legend's place: the file's, or where it hides nothing; an outer one narrows the frame.
// taken: part of the frame that something else covers, NULL: none. A box without height: no legend.
static Box legend_settle(const Page *page, const PlotPanel *panel, double share, const Box *taken,
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

// Only series with a label, in their order: a sample of line and mark, then the words.
static void legend_draw(const Page *page, const Axes *axes, const PlotPanel *panel, const Box *box,
                        double share)
{
    TextStyle style = {.size = axes->number_size * page->point, .color = INK, .up = 0.5};
    double sample = LEGEND_SAMPLE * page->point, gap = LEGEND_GAP * page->point;
    double pitch = LEGEND_PITCH * style.size, y = box->top + pitch / 2;
    if (!(box->bottom > box->top)) return;
    for (int32_t k = 0; k < panel->series_count; ++k) {
        const PlotSeries *series = &panel->series[k];
        if (!series->label[0]) continue;
        Stroke stroke = line_stroke(page, series, share);
        if (series->line != LINE_NONE)
            shape_segment(page->canvas, &stroke, (Point){box->left, y},
                          (Point){box->left + sample, y});
        marker_draw(page, series, (Point){box->left + sample / 2, y}, share);
        text_draw(page->text, &style, (Point){box->left + sample + gap, y}, series->label);
        y += pitch;
    }
}

// Lines and bars are cut off at the frame; a mark on the frame is drawn whole, one beyond it not at
// all. taken: as in legend_settle; *axes is narrowed by an outer legend.
static bool panel_draw(const Page *page, const PlotPanel *panel, double share, const Box *taken,
                       Axes *axes, Error *err)
{
    Box legend = legend_settle(page, panel, share, taken, axes);
    canvas_clip(page->canvas, &axes->box);
    for (int32_t k = 0; k < panel->series_count; ++k)
        TRY(line_draw(page, axes, &panel->series[k], share, err));
    for (int32_t k = 0; k < panel->series_count; ++k) bars_draw(page, axes, &panel->series[k]);
    canvas_clip(page->canvas, NULL);   // a mark on the frame is drawn whole
    for (int32_t k = 0; k < panel->series_count; ++k) {
        const PlotSeries *series = &panel->series[k];
        for (int32_t i = 0; i < series->count; ++i) {
            Point at = axes_place(axes, series->x[i], series->y[i]);
            bool inside = at.x >= axes->box.left - 1 && at.x <= axes->box.right + 1 &&
                          at.y >= axes->box.top - 1 && at.y <= axes->box.bottom + 1;
            if (inside) marker_draw(page, series, at, share);
        }
    }
    legend_draw(page, axes, panel, &legend, share);
    axes_draw(page, axes);
cleanup:
    return error_is_clean(err);
}

// From parts of the frame to pixels.
static Box inset_place(const Plot *plot, const Box *frame)
{
    double width = frame->right - frame->left, height = frame->bottom - frame->top;
    return (Box){.left = frame->left + plot->place[0] * width,
                 .top = frame->top + plot->place[1] * height,
                 .right = frame->left + plot->place[2] * width,
                 .bottom = frame->top + plot->place[3] * height};
}

// The inset's frame is what is left of its place when its numbers and names have their room.
static Axes inset_axes(const Page *page, const Plot *plot, const Box *frame)
{
    Axes axes = {.box = inset_place(plot, frame),
                 .x = plot->inset.x,
                 .y = plot->inset.y,
                 .number_size = SMALL_SIZE,
                 .color = INK};
    axes.box.left = round(axes.box.left + axes_left_margin(page, &axes) * page->point);
    axes.box.bottom = round(axes.box.bottom - axes_bottom_margin(&axes) * page->point);
    axes.box.right = round(axes.box.right);
    axes.box.top = round(axes.box.top);
    return axes;
}

// The inset covers what lies below it: its place is cleared to paper first.
bool figure_curves(const Page *page, const Plot *plot, Error *err)
{
    double point = page->point;
    Axes axes = {.x = plot->main.x, .y = plot->main.y, .number_size = NUMBER_SIZE, .color = INK};
    axes.box.top = page->head + round(axes_top_margin(&axes) * point);
    axes.box.bottom = round(canvas_height(page->canvas) - axes_bottom_margin(&axes) * point);
    axes.box.left = round(axes_left_margin(page, &axes) * point);
    axes.box.right = round(canvas_width(page->canvas) - RIGHT_MARGIN * point);
    Box place = inset_place(plot, &axes.box);
    TRY(panel_draw(page, &plot->main, 1, plot->has_inset ? &place : NULL, &axes, err));
    if (plot->has_inset) {
        Axes inset = inset_axes(page, plot, &axes.box);
        place = inset_place(plot, &axes.box);   // an outer legend may have moved it
        shape_fill(page->canvas, PAPER, &place);
        TRY(panel_draw(page, &plot->inset, INSET_SHARE, NULL, &inset, err));
    }
cleanup:
    return error_is_clean(err);
}
