// SPDX-License-Identifier: GPL-2.0-or-later
// What the pictures over (U, x) share: frame, axes, pads, the grid of pixels, the front.
#include "render/figures/map_page.h"

#include "base/memory.h"
#include "render/figures/pad_marks.h"

#include <math.h>
#include <stdio.h>

static const double BAR_GAP = 6;   // points: frame to colour bar
static const double HATCH_SPACING = 4;   // points
static const double FRONT_WIDTH = 0.6;   // points
static const double EVENT_WIDTH = 0.4;   // points: what is thinner would not be seen in print
static const double EVENTS_SHARE = 0.2;   // of the frame's width that so wide events may take

static const double ROW_SLACK = 0.25;   // pixels by which a row may be off

static const Color HATCH_COLOR = {0.72f, 0.72f, 0.74f, 1};

Axis figure_length_axis(const ResultView *view, const char *symbol, double low, double high)
{
    char name[16];
    Axis axis = {.low = low, .high = high, .factor = 1};
    snprintf(name, sizeof name, "~{%.8s}", symbol);
    if (view->si)
        axis_set_unit(&axis, name, "m");
    else
        snprintf(axis.label, sizeof axis.label, "%s / ~{L}_{0}", name);
    return axis;
}

// 0 in results that do not say it, which are older.
double figure_trailing_end(const ResultView *view)
{
    double x = view->number[NUMBER_TRAILING];
    return isfinite(x) ? x : 0;
}

void figure_x_extent(const ResultView *view, double *low, double *high)
{
    double begin = figure_trailing_end(view), length = view->number[NUMBER_LENGTH];
    double end = isfinite(length) && length > 0 ? begin + length : begin;
    *low = fmin(begin, view->x[0]);
    *high = fmax(end, view->x[view->nodes - 1]);
    if (!(*high > *low)) *high = *low + 1;   // one node at 0
}

// A rapid event is thinner than a pixel: it is drawn as wide as print shows, or, where there are
// so many that they would hide what lies between, one pixel wide.
static int32_t event_columns(const Page *page, const ResultView *view, double U_low, double U_high,
                             int32_t columns)
{
    int32_t shown = 0, wide = (int32_t)fmax(1, round(EVENT_WIDTH * page->point));
    for (int32_t k = 0; k < view->rapid_count; ++k)
        shown += view->rapid[k][1] >= U_low && view->rapid[k][0] <= U_high;
    return (double)shown * wide < EVENTS_SHARE * columns ? wide : 1;
}

// In a PDF or SVG an image has no more rows than it needs: nodes that are evenly spaced stand on so
// many rows, to a part of a pixel, that each begins where a row does.
static int32_t rows_needed(const Page *page, const ResultView *view, const Axes *axes)
{
    SpaceTime data = {.nodes = view->nodes, .x = view->x, .pad = view->pad};
    int32_t pixels = (int32_t)(axes->box.bottom - axes->box.top);
    double least = INFINITY, from = 0, to = 0, height = axes->y.high - axes->y.low;
    for (int32_t i = 0; i < view->nodes; ++i) {
        node_extent(&data, i, &from, &to);
        if (to > from) least = fmin(least, to - from);
    }
    double rows = round(height / least);
    if (!canvas_is_vector(page->canvas) || !(rows >= 2 && rows < pixels)) return pixels;
    for (int32_t i = 0; i < view->nodes; ++i) {
        node_extent(&data, i, &from, &to);
        double row = (from - axes->y.low) / height * rows;
        if (fabs(row - round(row)) * pixels > ROW_SLACK * rows) return pixels;
    }
    return (int32_t)rows;
}

void map_page_layout(const Page *page, const ResultView *view, double U_low, double U_high,
                     MapPage *map)
{
    double x_low = 0, x_high = 0, point = page->point;
    uint8_t colors[3 * MAP_SIZE];
    Axes *axes = &map->axes;
    figure_x_extent(view, &x_low, &x_high);
    axes->x = figure_length_axis(view, "U", U_low, U_high);
    axes->y = figure_length_axis(view, "x", x_low, x_high);
    axes->number_size = NUMBER_SIZE;
    axes->color = INK;
    axes->bare_x = page->bare_x;
    axes->box.top = page->room.top + round(fmax(axes_top_margin(axes), map->above) * point);
    axes->box.bottom = round(page->room.bottom - axes_bottom_margin(axes) * point);
    axes->box.left = round(page->room.left + axes_left_margin(page, axes) * point);
    map->pads_width = pad_marks_width(page, view);
    double beside = BAR_GAP + map->pads_width + map->mark_width + colorbar_width(page, &map->bar);
    axes->box.right = round(page->room.right - beside * point);
    page_place_frame(page, &axes->box);
    int32_t columns = (int32_t)(axes->box.right - axes->box.left);
    color_map_fill(colors);
    canvas_set_map(page->canvas, colors, map->bar.neutral_color);
    map->grid = (PixelGrid){.U_low = U_low,
                            .U_high = U_high,
                            .x_low = x_low,
                            .x_high = x_high,
                            .columns = columns,
                            .event_columns = event_columns(page, view, U_low, U_high, columns),
                            .rows = rows_needed(page, view, axes)};
}

// What space_time needs of a result; the statuses only where a figure asks for them.
static SpaceTime view_space_time(const ResultView *view)
{
    return (SpaceTime){.rows = view->rows,
                       .U = view->U,
                       .nodes = view->nodes,
                       .x = view->x,
                       .pad = view->pad,
                       .value = view->slip_rate,
                       .V = fabs(view->number[NUMBER_ROD_VELOCITY]),
                       .event_count = view->rapid_count,
                       .events = (const double(*)[2])view->rapid};
}

bool map_page_fill(const ResultView *view, const double *status, MapPage *map, Error *err)
{
    SpaceTime data = view_space_time(view);
    data.status = status;
    if (map->mean) data.slip = view->slip;
    if (map->states) {
        data.value = map->states;
        data.sign = map->sign;
    }
    if (map->grid.columns < 2 || map->grid.rows < 2)
        FAIL(err, ERROR_INPUT, "the picture is too small for its axes");
    TRY(space_time_to_pixels(&data, &map->grid, err));
cleanup:
    return error_is_clean(err);
}

void map_page_levels(MapPage *map)
{
    int64_t count = (int64_t)map->grid.bands * map->grid.columns;
    for (int64_t k = 0; k < count; ++k)
        map->grid.values[k] = colorbar_level(&map->bar, (double)map->grid.values[k]);
}

int32_t map_page_key(const ResultView *view, const Window *window, KeyEntry entries[2])
{
    int32_t count = 0;
    if (view->pad[view->nodes - 1] > 0)
        entries[count++] = (KeyEntry){KEY_HATCH, {0.5f, 0.5f, 0.52f, 1}, "between pads"};
    if (window && window->words[0]) entries[count++] = (KeyEntry){.words = window->words};
    return count;
}

// Hatches [low, high] of x over all U.
static void gap_draw(const Page *page, const Axes *axes, double low, double high)
{
    Stroke hatch = {.color = HATCH_COLOR, .width = 0.4 * page->point};
    Point from = axes_place(axes, axes->x.low, high), to = axes_place(axes, axes->x.high, low);
    Box box = {from.x, from.y, to.x, to.y};
    if (box.bottom - box.top < 1) return;
    draw_hatch(page->canvas, &hatch, &box, HATCH_SPACING * page->point);
}

// Gaps are what no node stands for, found on a walk over the nodes along x.
void map_page_draw_field(const Page *page, const ResultView *view, const MapPage *map)
{
    const Axes *axes = &map->axes;
    SpaceTime data = view_space_time(view);
    double covered = axes->y.low, from = 0, to = 0;
    const HeatMap heat = {map->grid.columns, map->grid.bands, map->grid.values, map->grid.band,
                          map->grid.rows};
    canvas_heat(page->canvas, &axes->box, &heat);
    for (int32_t i = 0; i < view->nodes; ++i) {
        node_extent(&data, i, &from, &to);
        if (from > covered) gap_draw(page, axes, covered, from);
        covered = fmax(covered, to);
    }
    if (axes->y.high > covered) gap_draw(page, axes, covered, axes->y.high);
}

// The x up to which the nodes of one pad, from its trailing end on, do not stick.
static double pad_front(const ResultView *view, int64_t row, int32_t first, int32_t last)
{
    static const double stick = 1;
    const double *status = view->status + row * view->nodes;
    double front = view->x[first];
    for (int32_t i = first; i <= last && status[i] != stick; ++i) front = view->x[i];
    return front;
}

// Whether it, or a line to a row beside it, lies in what is shown.
static bool row_is_shown(const ResultView *view, int64_t row, const Axis *shown)
{
    double before = view->U[row > 0 ? row - 1 : row], here = view->U[row];
    double after = view->U[row + 1 < view->rows ? row + 1 : row];
    return fmax(fmax(before, here), after) >= shown->low &&
           fmin(fmin(before, here), after) <= shown->high;
}

// A front a pad: one line over all of them would leap over gaps, and would not see what goes on
// ahead of the first node that sticks.
bool map_page_draw_front(const Page *page, const ResultView *view, const MapPage *map, Error *err)
{
    Stroke stroke = {.color = INK, .width = FRONT_WIDTH * page->point};
    Point *line = NULL;
    TRY(line = NEW_ARRAY(Point, view->rows, err));
    canvas_clip(page->canvas, &map->axes.box);
    for (int32_t first = 0, last = 0; first < view->nodes; first = ++last) {
        while (last + 1 < view->nodes && view->pad[last + 1] == view->pad[first]) ++last;
        for (int64_t row = 0; row < view->rows; ++row)
            line[row] =
                row_is_shown(view, row, &map->axes.x)
                    ? axes_place(&map->axes, view->U[row], pad_front(view, row, first, last))
                    : (Point){NAN, NAN};
        draw_line(page->canvas, &stroke, line, view->rows);
    }
    canvas_clip(page->canvas, NULL);
cleanup:
    memory_free(line);
    return error_is_clean(err);
}

void map_page_draw_frame(const Page *page, const ResultView *view, const MapPage *map)
{
    Box bar = map->axes.box;
    bar.left = round(bar.right + (BAR_GAP + map->pads_width + map->mark_width) * page->point);
    axes_draw(page, &map->axes);
    pad_marks_draw(page, view, &map->axes, map->mark_width);
    colorbar_draw(page, &map->bar, &bar);
}

void map_page_destroy(MapPage *map)
{
    pixel_grid_destroy(&map->grid);
}
