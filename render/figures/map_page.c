// SPDX-License-Identifier: GPL-2.0-or-later
// Parts that the pictures over (U, x) share: frame, axes, pads, the grid of pixels, the front.
#include "render/figures/map_page.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double AREA_RADIUS = 1.6;   // points: of measured areas
static const double BAR_GAP = 6;   // points: frame to colour bar
static const double HATCH_SPACING = 4;   // points
static const double FRONT_WIDTH = 0.6;   // points
static const double EVENT_WIDTH = 0.4;   // points: what is thinner would not be seen in print
static const double EVENTS_SHARE = 0.2;   // of the frame's width that so wide events may take

static const double ROW_SLACK = 0.25;   // pixels by which a row may be off

static const double PAD_GAP = 1.6;   // points: frame to bar
static const double PAD_WIDTH = 1.2;   // points
static const double PAD_NAME_GAP = 1.6;   // points: bar to name
static const Color PAD_COLOR = {0.45f, 0.46f, 0.48f, 1};
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

// --- names of pads -------------------------------------------------------------------------------

// A bar and a name for each pad at the right of a map, so that gaps in it can be told from open
// contact. A single contact needs none.
enum { PAD_NAME_SIZE = 96 };

// "contact_3" is shown as pad 3, a name of the user's own as it is; without names, numbers from 1.
static void pad_name(const ResultView *view, int32_t pad, char name[PAD_NAME_SIZE])
{
    static const char common[] = "contact_";
    int length = 0, skip = sizeof common - 1;
    const char *start = result_view_name(view->pad_names, pad, &length);
    if (length == 0)
        snprintf(name, PAD_NAME_SIZE, "pad %d", pad + 1);
    else if (length > skip && strncmp(start, common, sizeof common - 1) == 0)
        snprintf(name, PAD_NAME_SIZE, "pad %.*s", length - skip, start + skip);
    else
        snprintf(name, PAD_NAME_SIZE, "%.*s", length, start);
}

// Extent of a pad along x; false: no node is on it.
static bool pad_extent(const ResultView *view, int32_t pad, double *from, double *to)
{
    *from = INFINITY;
    *to = -INFINITY;
    for (int32_t i = 0; i < view->nodes; ++i) {
        if ((int32_t)view->pad[i] != pad) continue;
        *from = fmin(*from, view->x[i]);
        *to = fmax(*to, view->x[i]);
    }
    return *to >= *from;
}

static double pad_marks_width(const Page *page, const ResultView *view)
{
    char name[PAD_NAME_SIZE];
    double widest = 0;
    int32_t count = result_view_pads(view);
    if (count < 2) return 0;
    for (int32_t pad = 0; pad < count; ++pad) {
        pad_name(view, pad, name);
        widest = fmax(widest, text_width(page->text, SMALL_SIZE * page->point, name));
    }
    return PAD_GAP + PAD_WIDTH + PAD_NAME_GAP + widest / page->point;
}

static void pad_marks_draw(const Page *page, const ResultView *view, const Axes *axes,
                           double beside)
{
    double point = page->point, from = 0, to = 0;
    double left = axes->box.right + (beside + PAD_GAP) * point;
    TextStyle style = {.size = SMALL_SIZE * point, .color = INK, .up = 0.5};
    int32_t count = result_view_pads(view);
    for (int32_t pad = 0; count > 1 && pad < count; ++pad) {
        char name[PAD_NAME_SIZE];
        if (!pad_extent(view, pad, &from, &to)) continue;
        Point low = axes_place(axes, axes->x.high, from), high = axes_place(axes, axes->x.high, to);
        Box bar = {left, high.y, left + PAD_WIDTH * point, fmax(low.y, high.y + 1)};
        draw_fill(page->canvas, PAD_COLOR, &bar);
        pad_name(view, pad, name);
        Point place = {bar.right + PAD_NAME_GAP * point, (low.y + high.y) / 2};
        text_draw(page->text, &style, place, name);
    }
}

// --- the map -------------------------------------------------------------------------------------

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

static void lay_out(const Page *page, const ResultView *view, const double U[2], MapPage *map)
{
    double x[2] = {0, 0};
    Axes *axes = &map->axes;
    result_view_x_extent(view, &x[0], &x[1]);
    axes->x = figure_length_axis(view, "U", U[0], U[1]);
    axes->y = figure_length_axis(view, "x", x[0], x[1]);
    axes->bare_x = page->bare_x;
    map->pads_width = pad_marks_width(page, view);
    double beside = BAR_GAP + map->pads_width + map->mark_width + colorbar_width(page, &map->bar);
    axes_fit(page, &page->room, beside, axes);
    int32_t columns = (int32_t)(axes->box.right - axes->box.left);
    map->grid = (PixelGrid){.U_low = U[0],
                            .U_high = U[1],
                            .x_low = x[0],
                            .x_high = x[1],
                            .columns = columns,
                            .event_columns = event_columns(page, view, U[0], U[1], columns),
                            .rows = rows_needed(page, view, axes)};
}

// Place of a value in the colours. For contact density it is the density that is lost, over the
// range of the bar; open contact is infinitely fast.
static float level_of(const MapPage *map, double value)
{
    if (!(map->critical > 0)) return colorbar_level(&map->bar, value);
    if (isnan(value)) return HEAT_MISSING;
    return isinf(value) ? (float)HEAT_BELOW
                        : (float)fmin(value / map->critical / (1 - map->bar.low), 1);
}

bool map_page_fill(const SpaceTime *data, MapPage *map, Error *err)
{
    if (map->grid.columns < 2 || map->grid.rows < 2)
        return REFUSE(err, "the picture is too small for its axes");
    if (!space_time_to_pixels(data, &map->grid, err)) return false;
    for (int64_t k = 0; k < (int64_t)map->grid.bands * map->grid.columns; ++k)
        map->grid.values[k] = level_of(map, (double)map->grid.values[k]);
    return true;
}

bool map_page_draw(const Page *page, const ResultView *view, const double U[2], MapPage *map,
                   Error *err)
{
    lay_out(page, view, U, map);
    SpaceTime data = {.rows = view->rows,
                      .U = view->U,
                      .nodes = view->nodes,
                      .x = view->x,
                      .pad = view->pad,
                      .value = map->states ? map->states : view->slip_rate,
                      .sign = map->sign,
                      .status = map->status,
                      .slip = map->mean ? view->slip : NULL,
                      .V = fabs(view->number[NUMBER_ROD_VELOCITY]),
                      .event_count = view->rapid_count,
                      .events = (const double(*)[2])view->rapid};
    if (!map_page_fill(&data, map, err)) return false;
    map_page_draw_field(page, view, map);
    return true;
}

int32_t map_page_key(const ResultView *view, const ViewRange *shown, KeyEntry entries[2])
{
    int32_t count = 0;
    if (view->pad[view->nodes - 1] > 0)
        entries[count++] = (KeyEntry){KEY_HATCH, {0.5f, 0.5f, 0.52f, 1}, "between pads"};
    if (shown && shown->words[0]) entries[count++] = (KeyEntry){.words = shown->words};
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
    SpaceTime data = {.nodes = view->nodes, .x = view->x, .pad = view->pad};
    double covered = axes->y.low, from = 0, to = 0;
    const HeatMap heat = {map->grid.columns, map->grid.bands, map->grid.values, map->grid.band,
                          map->grid.rows};
    canvas_set_below(page->canvas, map->bar.neutral_color);
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
void map_page_draw_front(const Page *page, const ResultView *view, const MapPage *map)
{
    Stroke stroke = {.color = INK, .width = FRONT_WIDTH * page->point};
    canvas_clip(page->canvas, &map->axes.box);
    for (int32_t first = 0, last = 0; first < view->nodes; first = ++last) {
        while (last + 1 < view->nodes && view->pad[last + 1] == view->pad[first]) ++last;
        LinePen pen = line_begin(page->canvas, &stroke);
        for (int64_t row = 0; row < view->rows; ++row) {
            if (row_is_shown(view, row, &map->axes.x))
                line_add(&pen,
                         axes_place(&map->axes, view->U[row], pad_front(view, row, first, last)));
            else
                pen.down = false;
        }
        line_end(&pen);
    }
    canvas_clip(page->canvas, NULL);
}

void map_page_draw_frame(const Page *page, const ResultView *view, const MapPage *map)
{
    axes_draw(page, &map->axes);
    pad_marks_draw(page, view, &map->axes, map->mark_width);
    colorbar_draw(page, &map->bar, &map->axes.box, BAR_GAP + map->pads_width + map->mark_width);
}

// Discs in the colours of the map, so that one that agrees does not stand out but for its rim.
void map_page_draw_areas(const Page *page, const Measured *measured, const MapPage *map)
{
    uint8_t colors[MAP_SIZE * 3];
    double radius = AREA_RADIUS * page->point;
    color_map_fill(colors);
    canvas_clip(page->canvas, &map->axes.box);
    for (int32_t k = 0; k < measured->count; ++k) {
        Point at = axes_place(&map->axes, measured->at[k], measured->x[k]);
        double lost = (map->bar.high - measured->value[k]) / (map->bar.high - map->bar.low);
        const uint8_t *color = colors + 3 * (int32_t)lround(255 * fmin(fmax(lost, 0), 1));
        Color inside = {(float)color[0] / 255, (float)color[1] / 255, (float)color[2] / 255, 1};
        draw_disc(page->canvas, PAPER, at, radius + 0.8 * page->point);
        draw_disc(page->canvas, INK, at, radius + 0.4 * page->point);
        draw_disc(page->canvas, inside, at, radius);
    }
    canvas_clip(page->canvas, NULL);
}

void map_page_destroy(MapPage *map)
{
    pixel_grid_destroy(&map->grid);
}
