// SPDX-License-Identifier: GPL-2.0-or-later
// The figures over (U, x): slip rates, states, contact density and contact area. They share frame,
// axes, names of pads, the grid of pixels, and lines on it.
#include "render/figures/figure_maps.h"

#include "base/memory.h"
#include "base/order.h"
#include "io/hdf5/result_tables.h"
#include "render/canvas/key.h"
#include "render/figures/color_scale.h"
#include "render/figures/columns.h"
#include "render/figures/figures.h"
#include "render/figures/measured.h"
#include "render/view/zoom.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double AREA_RADIUS = 1.6;   // points: of measured areas
static const double BAR_GAP = 6;   // points: frame to colour bar
static const double HATCH_SPACING = 4;   // points
static const double FRONT_WIDTH = 0.6;   // points
static const double EVENT_WIDTH = 0.4;   // points: what is thinner would not be seen in print
static const double EVENTS_SHARE = 0.2;   // of the frame's width that so wide events may take

static const double PAD_GAP = 1.6;   // points: frame to bar
static const double PAD_WIDTH = 1.2;   // points
static const double PAD_NAME_GAP = 1.6;   // points: bar to name
static const Color PAD_COLOR = {0.45f, 0.46f, 0.48f, 1};
static const Color HATCH_COLOR = {0.72f, 0.72f, 0.74f, 1};
static const Color MAP_OPEN = {0.55f, 0.56f, 0.58f, 1};   // contact that has lifted off

// --- the field -----------------------------------------------------------------------------------

bool map_page_fill(const SpaceTime *data, MapPage *map, Error *err)
{
    PixelGrid *grid = &map->grid;
    if (grid->columns < 2 || grid->rows < 2)
        return REFUSE(err, "the picture is too small for its axes");
    if (!space_time_to_pixels(data, grid, err)) return false;
    for (int64_t k = 0; k < (int64_t)grid->rows * grid->columns; ++k)
        grid->values[k] = colorbar_level(&map->bar, (double)grid->values[k]);
    return true;
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
    const HeatMap heat = {map->grid.columns, map->grid.rows, map->grid.values};
    canvas_set_below(page->canvas, map->bar.neutral_color);
    canvas_heat(page->canvas, &axes->box, &heat);
    for (int32_t i = 0; i < view->nodes; ++i) {
        node_extent(&data, i, &from, &to);
        if (from > covered) gap_draw(page, axes, covered, from);
        covered = fmax(covered, to);
    }
    if (axes->y.high > covered) gap_draw(page, axes, covered, axes->y.high);
}

void map_page_destroy(MapPage *map)
{
    pixel_grid_destroy(&map->grid);
}

// Places the frame for U from U[0] to U[1] and all x, and draws the field with the gaps of pads;
// sets grid, pads_width and the axes but for `above`.
static bool map_draw(const Page *page, const ResultView *view, const double U[2], MapPage *map,
                     Error *err)
{
    double x[2] = {0, 0}, widest = 0;
    int32_t pads = result_view_pads(view), shown = 0;
    Axes *axes = &map->axes;
    result_view_x_extent(view, &x[0], &x[1]);
    axes->x = figure_length_axis(view, "U", U[0], U[1]);
    axes->y = figure_length_axis(view, "x", x[0], x[1]);
    axes->bare_x = page->bare_x;

    // Right of the frame stand a bar and a name for each of several pads.
    for (int32_t pad = 0; pads > 1 && pad < pads; ++pad) {
        char name[PAD_NAME_SIZE];
        result_view_pad(view, pad, name);
        widest = fmax(widest, text_width(page->text, SMALL_SIZE * page->point, name));
    }
    if (pads > 1) map->pads_width = PAD_GAP + PAD_WIDTH + PAD_NAME_GAP + widest / page->point;
    double beside = BAR_GAP + map->pads_width + map->mark_width + colorbar_width(page, &map->bar);
    axes_fit(page, &page->room, beside, axes);

    // A rapid event is thinner than a pixel: it is drawn as wide as print shows, or, where there
    // are so many that they would hide what lies between, one pixel wide.
    int32_t columns = (int32_t)(axes->box.right - axes->box.left);
    int32_t wide = (int32_t)fmax(1, round(EVENT_WIDTH * page->point));
    for (int32_t k = 0; k < view->rapid_count; ++k)
        shown += view->rapid[k][1] >= U[0] && view->rapid[k][0] <= U[1];
    if (!((double)shown * wide < EVENTS_SHARE * columns)) wide = 1;

    map->grid = (PixelGrid){.U_low = U[0],
                            .U_high = U[1],
                            .x_low = x[0],
                            .x_high = x[1],
                            .columns = columns,
                            .event_columns = wide,
                            .rows = (int32_t)(axes->box.bottom - axes->box.top)};
    SpaceTime data = {.rows = view->rows,
                      .U = view->U,
                      .nodes = view->nodes,
                      .x = view->x,
                      .pad = view->pad,
                      .value = map->states ? map->states : view->slip_rate,
                      .sign = map->sign,
                      .slip = map->mean ? view->slip : NULL,
                      .V = fabs(view->number[NUMBER_ROD_VELOCITY]),
                      .event_count = view->rapid_count,
                      .events = (const double(*)[2])view->rapid};
    if (!map_page_fill(&data, map, err)) return false;
    map_page_draw_field(page, view, map);
    return true;
}

// --- what stands on it and around it -------------------------------------------------------------

// Adds the entries of pads and of the range shown to a key; returns how many they are, at most two.
static int32_t map_key(const ResultView *view, const ViewRange *shown, KeyEntry entries[2])
{
    int32_t count = 0;
    if (view->pad[view->nodes - 1] > 0)
        entries[count++] = (KeyEntry){KEY_HATCH, {0.5f, 0.5f, 0.52f, 1}, "between pads"};
    if (shown && shown->words[0]) entries[count++] = (KeyEntry){.words = shown->words};
    return count;
}

// Discs in the colours of the map, so that one that agrees does not stand out but for its rim.
static void areas_draw(const Page *page, const Measured *measured, const MapPage *map)
{
    double radius = AREA_RADIUS * page->point;
    canvas_clip(page->canvas, &map->axes.box);
    for (int32_t k = 0; k < measured->count; ++k) {
        Point at = axes_place(&map->axes, measured->at[k], measured->x[k]);
        double lost = (map->bar.high - measured->value[k]) / (map->bar.high - map->bar.low);
        draw_disc(page->canvas, PAPER, at, radius + 0.8 * page->point);
        draw_disc(page->canvas, INK, at, radius + 0.4 * page->point);
        canvas_heat_disc(page->canvas, at, radius, (float)fmin(fmax(lost, 0), 1));
    }
    canvas_clip(page->canvas, NULL);
}

// Frame, axes, a bar and a name for each pad, so that gaps can be told from open contact, and the
// colour bar: last. A single contact needs no name.
static void frame_draw(const Page *page, const ResultView *view, const MapPage *map)
{
    const Axes *axes = &map->axes;
    double point = page->point, left = axes->box.right + (map->mark_width + PAD_GAP) * point;
    TextStyle style = {.size = SMALL_SIZE * point, .color = INK, .up = 0.5};
    int32_t count = result_view_pads(view);
    axes_draw(page, axes);
    for (int32_t pad = 0; count > 1 && pad < count; ++pad) {
        char name[PAD_NAME_SIZE];
        double from = INFINITY, to = -INFINITY;
        for (int32_t i = 0; i < view->nodes; ++i) {
            if ((int32_t)view->pad[i] != pad) continue;
            from = fmin(from, view->x[i]);
            to = fmax(to, view->x[i]);
        }
        if (!(to >= from)) continue;
        Point low = axes_place(axes, axes->x.high, from), high = axes_place(axes, axes->x.high, to);
        Box bar = {left, high.y, left + PAD_WIDTH * point, fmax(low.y, high.y + 1)};
        draw_fill(page->canvas, PAD_COLOR, &bar);
        result_view_pad(view, pad, name);
        Point place = {bar.right + PAD_NAME_GAP * point, (low.y + high.y) / 2};
        text_draw(page->text, &style, place, name);
    }
    colorbar_draw(page, &map->bar, &axes->box, BAR_GAP + map->pads_width + map->mark_width);
}

// --- slip-map ------------------------------------------------------------------------------------

static const double MARK_WIDTH = 9;   // points: room for the name l_c
static const double ZOOM_GAP = 0.8;   // points: frame to the bar that marks the zoom
static const double ZOOM_BAR = 1.8;   // points: height of that bar
static const double ZOOM_DESCENT = 2;   // points: bar to the foot of its name
static const double ZOOM_LEADER_LENGTH = 6, NAME_SPACE = 1.6;   // points: along it, and behind it
static const double ZOOM_ABOVE = 11;   // points above the frame that bar and name take
static const double EXPONENT_WIDTH = 4;   // of the numbers' size: a power of ten at the left
static const double ZOOM_LEADER = 0.5;   // points: width of the line from its name to the bar

// A bar above the frame, in the colour of the contact-density map's frame: what that one enlarges.
// Its name stands beside it, where there is more room, with a line that leads from it to the bar.
static void zoom_draw(const Page *page, const Zoom *zoom, const Axes *axes)
{
    double foot = axes->box.top - ZOOM_GAP * page->point;
    TextStyle style = {.size = SMALL_SIZE * page->point, .color = ZOOM_DENSITY};
    Point from = axes_place(axes, zoom->U_low, 0), to = axes_place(axes, zoom->U_high, 0);
    Box bar = {from.x, foot - ZOOM_BAR * page->point, fmax(to.x, from.x + page->point), foot};
    double width = text_width(page->text, style.size, page->zoom_name);
    double first = axes->box.left + EXPONENT_WIDTH * axes_number_size(axes) * page->point;
    double middle = (bar.left + bar.right) / 2, gap = ZOOM_LEADER_LENGTH * page->point;
    bool before = middle - gap - width > first;   // the name stands left of the bar
    double height = bar.top - ZOOM_DESCENT * page->point;
    double words = height - text_digit_height() * style.size / 2;
    Stroke leader = {.color = ZOOM_DENSITY, .width = ZOOM_LEADER * page->point};
    const Point line[3] = {
        {middle, bar.top}, {middle, words}, {middle + (before ? -gap : gap), words}};
    style.across = before ? 1 : 0;
    double space = (before ? -1 : 1) * NAME_SPACE * page->point;
    draw_fill(page->canvas, ZOOM_DENSITY, &bar);
    draw_line(page->canvas, &leader, line, 3);
    text_draw(page->text, &style, (Point){line[2].x + space, height}, page->zoom_name);
}

// Figure 1(c) of the paper: |slip rate| / V on a logarithmic scale. What slips slower than the
// range shows is neutral: stick.
bool figure_slip_map(const Page *whole, ResultView *view, Error *err)
{
    Page page = *whole;
    ViewRange shown;
    Measured measured = {0};
    double length = view->number[NUMBER_L_C], V = fabs(view->number[NUMBER_ROD_VELOCITY]);
    Zoom zoom = zoom_choose(view);
    MapPage map = {.mean = page.style.pixels && strcmp(page.style.pixels, "mean") == 0};
    if (!(V > 0)) FAIL(err, ERROR_INPUT, "the result does not say how fast the rod moves");
    TRY(view_range_find(view, &page.style, &shown, err));
    bool marked = page.zoom_name && zoom.found && zoom.U_low >= shown.low;
    if (marked) map.axes.above = ZOOM_ABOVE;
    TRY(result_view_read_slip_rate(view, err));
    if (map.mean) TRY(result_view_read_slip(view, err));
    map.bar = slip_scale(view, V);
    snprintf(map.bar.label, sizeof map.bar.label, "%s slip rate / ~{V}",
             map.mean ? "mean" : "largest");
    if (isfinite(length)) map.mark_width = MARK_WIDTH;
    TRY(measured_read(page.style.compare, MEASURED_FRONT, view, &measured, err));

    // The line l_c has its name at its end.
    KeyEntry entries[3];
    int32_t count = map_key(view, &shown, entries);
    key_draw(&page, entries, measured_key(&measured, KEY_DISC, entries, count));

    TRY(map_draw(&page, view, (double[]){shown.low, shown.high}, &map, err));
    if (marked) zoom_draw(&page, &zoom, &map.axes);
    if (isfinite(length)) {
        // The critical length of the quasi-static precursor, as the paper's figure has it: a dashed
        // line.
        Stroke stroke = dashed_stroke(&page, INK, 0.6);
        axes_level(&page, &map.axes, &stroke, result_view_trailing_end(view) + length, 1.6,
                   "~{l}_{c}");
    }

    measured_draw(&page, &measured, -1, &map.axes);
    frame_draw(&page, view, &map);
cleanup:
    measured_destroy(&measured);
    map_page_destroy(&map);
    return error_is_clean(err);
}

// Writes how far slip has come, against U.
bool figure_slip_map_table(const char *path, ResultView *view, const FieldChoice *field, Error *err)
{
    ViewCurve front;
    (void)field;
    if (!computed_curve(view, MEASURED_FRONT, &front, err)) return false;
    const Column columns[] = {{"U", "m", front.at}, {"t", "s", view->t}, {"x", "m", front.value}};
    return columns_write(path, columns, 3, front.count, view->si, err);
}

// --- state-map -----------------------------------------------------------------------------------

bool figure_state_map_is_there(const ResultView *view)
{
    return view->states > 0;
}

// A pixel shows the smallest of its values, as slip makes contacts young at once and rest
// strengthens them slowly.
bool figure_state_map(const Page *whole, ResultView *view, Error *err)
{
    Page page = *whole;
    ViewRange shown;
    KeyEntry entries[2];
    char name[VIEW_STATE_SIZE];
    double *states = NULL;
    bool largest = page.style.pixels && strcmp(page.style.pixels, "largest") == 0;
    MapPage map = {.sign = largest ? 1 : -1};
    TRY(view_range_find(view, &page.style, &shown, err));
    TRY(result_view_read(view, SERIES_STATE, false, &states, err));
    ValueWords words = state_words(view, name);
    const double U[2] = {shown.low, shown.high};
    TRY(history_bar_fit(view, U, states, &words, &page.style, &map.bar, err));
    map.states = states;
    key_draw(&page, entries, map_key(view, &shown, entries));
    TRY(map_draw(&page, view, U, &map, err));
    frame_draw(&page, view, &map);
cleanup:
    memory_free(states);
    map_page_destroy(&map);
    return error_is_clean(err);
}

enum { OF_STATE = 3 };   // columns of each

// Least, median and largest of each state over the nodes.
bool figure_state_map_table(const char *path, ResultView *view, const FieldChoice *field,
                            Error *err)
{
    (void)field;
    static const char *const what[OF_STATE] = {"least", "median", "largest"};
    int32_t count = 2;
    Column *columns = NEW_ARRAY(Column, 2 + OF_STATE * view->states, err);
    char(*names)[VIEW_STATE_SIZE + 12] = memory_array(OF_STATE * view->states, sizeof *names, err);
    double **values = NEW_ARRAY(double *, OF_STATE * view->states, err), *states = NULL;
    TRY(columns && names && values);
    columns[0] = (Column){"U", "m", view->U};
    columns[1] = (Column){"t", "s", view->t};
    for (view->state = 0; view->state < view->states; ++view->state) {
        char name[VIEW_STATE_SIZE];
        ValueWords words = state_words(view, name);
        memory_free(states);
        states = NULL;
        TRY(result_view_read(view, SERIES_STATE, false, &states, err));
        double **own = values + OF_STATE * view->state;
        for (int32_t k = 0; k < OF_STATE; ++k) TRY(own[k] = NEW_ARRAY(double, view->rows, err));
        for (int64_t row = 0; row < view->rows; ++row) {
            double *sorted = states + row * view->nodes;
            qsort(sorted, (size_t)view->nodes, sizeof *sorted, order_doubles);
            for (int32_t k = 0; k < OF_STATE; ++k)
                own[k][row] = sorted[k * (view->nodes - 1) / (OF_STATE - 1)];
        }
        for (int32_t k = 0; k < OF_STATE; ++k, ++count) {
            snprintf(names[count - 2], sizeof *names, "%s %s", what[k], name);
            columns[count] =
                (Column){names[count - 2], words.si[0] ? words.si : NULL, values[count - 2]};
        }
    }
    TRY(columns_write(path, columns, count, view->rows, view->si, err));
cleanup:
    view->state = 0;
    for (int32_t k = 0; values && k < OF_STATE * view->states; ++k) memory_free(values[k]);
    memory_free_all(columns, names, values, states);
    return error_is_clean(err);
}

// --- contact-density, contact-area ---------------------------------------------------------------

enum { RANGES = 5 };
static const double RANGE_LOW[RANGES] = {0.9, 0.75, 0.5, 0.25, 0};   // where the scale may start

// A front a pad, l(U): one line over all of them would leap over gaps, and would not see what goes
// on ahead of the first node that sticks.
static void front_draw(const Page *page, const ResultView *view, const MapPage *map)
{
    const Axis *shown = &map->axes.x;
    Stroke stroke = {.color = INK, .width = FRONT_WIDTH * page->point};
    canvas_clip(page->canvas, &map->axes.box);
    for (int32_t first = 0, last = 0; first < view->nodes; first = ++last) {
        while (last + 1 < view->nodes && view->pad[last + 1] == view->pad[first]) ++last;
        LinePen pen = line_begin(page->canvas, &stroke);
        for (int64_t row = 0; row < view->rows; ++row) {
            // A row, or a line to one beside it, may lie in what is shown.
            double before = view->U[row > 0 ? row - 1 : row], here = view->U[row];
            double after = view->U[row + 1 < view->rows ? row + 1 : row];
            if (!(fmax(fmax(before, here), after) >= shown->low &&
                  fmin(fmin(before, here), after) <= shown->high)) {
                pen.down = false;
                continue;
            }

            // The x up to which the nodes of the pad, from its trailing end on, do not stick.
            const double *status = view->status + row * view->nodes;
            double front = view->x[first];
            for (int32_t i = first; i <= last && status[i] != STATUS_STICKS; ++i)
                front = view->x[i];
            line_add(&pen, axes_place(&map->axes, here, front));
        }
        line_end(&pen);
    }
    canvas_clip(page->canvas, NULL);
}

// The history holds the law's own measure of the area.
bool figure_contact_area_is_there(const ResultView *view)
{
    return result_file_has_series(view->file, SERIES_AREA);
}

// Maps of the last precursors before sliding, with a colour of its own for open contact.
// density: Figure 1(d) of the paper, the normalised density of the real contact area, phi =
// max(0, 1 - |slip rate| / v_c) (the paper's Methods), with the front of slip. Else the area of the
// real contacts over that at rest, A(x, t)/A_0, as it is seen by light that crosses a contact
// (Rubinstein, Cohen and Fineberg, Nature 430, 1005, 2004): where friction ages the law's own
// measure, which the history holds, else phi. A front takes a few per cent of the area, so that the
// colours span what the precursors leave, but for one per cent at each end, and no line covers the
// front.
static bool contact_map(const Page *whole, ResultView *view, bool density, Error *err)
{
    const ValueWords words = {.words = "contact area ~{A} / ~{A}_{0}", .si = "", .normalised = ""};
    Page page = *whole;
    double *area = NULL, critical = view->number[NUMBER_CRITICAL_VELOCITY], least = 1;
    Measured measured = {0};
    ViewRange shown = {0};
    KeyEntry entries[5];
    Zoom zoom = zoom_choose(view);
    MapPage map = {.sign = -1};
    bool asked = !density && (page.style.from || page.style.to), lifted = false;
    if (density && !(critical > 0)) FAIL(err, ERROR_INPUT, FIGURE_NO_DENSITY);

    // The range that is shown, and the part of it that the colours are for: sliding is darker than
    // any.
    if (density)
        result_view_range(view, &shown.low, &shown.high);
    else
        TRY(view_range_find(view, &page.style, &shown, err));
    if (zoom.found && !asked) {
        shown.low = zoom.U_low;
        shown.high = zoom.U_high;
    }
    double before[2] = {shown.low, shown.high}, slide = zoom.found ? zoom.U_slide : INFINITY;
    if (zoom.found && !asked && zoom.U_slide > shown.low) before[1] = zoom.U_slide;

    TRY(result_view_read_status(view, err));
    TRY(density ? result_view_read_slip_rate(view, err) : computed_area_read(view, err));
    TRY(area = NEW_ARRAY(double, view->rows * view->nodes, err));
    for (int64_t k = 0; k < view->rows * view->nodes; ++k) {
        double U = view->U[k / view->nodes];
        bool open = view->status[k] == STATUS_OPEN;
        area[k] = density ? 1 - fabs(view->slip_rate[k]) / critical : view->area[k];
        if (open)
            area[k] = -INFINITY;
        else if (U >= shown.low && U <= shown.high && U < slide)
            least = fmin(least, area[k]);
        lifted = lifted || (open && U >= shown.low && U <= shown.high);
    }
    map.states = area;
    if (density) {
        // The precursors fill the scale: far below v_c they would hardly show between 0 and 1.
        int32_t range = 0;
        while (range < RANGES - 1 && RANGE_LOW[range] > least) ++range;
        map.bar = (Colorbar){.low = RANGE_LOW[range],
                             .high = 1,
                             .factor = 1,
                             .clipped = RANGE_LOW[range] > 0,
                             .label = "contact density ~{\u03c6}"};
    } else {
        TRY(history_bar_fit(view, before, area, &words, &page.style, &map.bar, err));
        map.bar.clipped = map.bar.clipped || before[1] < shown.high;   // in sliding less is left
    }
    map.bar.falling = true;
    map.bar.neutral = lifted ? "open" : NULL;
    map.bar.neutral_color = MAP_OPEN;

    if (density != figure_contact_area_is_there(view))   // measured areas stand on one of the two
        TRY(measured_read(page.style.compare, MEASURED_AREA, view, &measured, err));
    int32_t count = 0;
    if (density) entries[count++] = (KeyEntry){KEY_LINE, INK, "front of slip"};
    count += map_key(view, NULL, entries + count);
    if (!asked && zoom.words[0]) entries[count++] = (KeyEntry){.words = zoom.words};
    key_draw(&page, entries, measured_key(&measured, KEY_RING, entries, count));
    TRY(map_draw(&page, view, (double[]){shown.low, shown.high}, &map, err));
    if (density) front_draw(&page, view, &map);
    areas_draw(&page, &measured, &map);
    if (density && zoom.found && page.zoom_name) map.axes.color = ZOOM_DENSITY;
    frame_draw(&page, view, &map);
cleanup:
    measured_destroy(&measured);
    memory_free(area);
    map_page_destroy(&map);
    return error_is_clean(err);
}

bool figure_contact_density(const Page *whole, ResultView *view, Error *err)
{
    return contact_map(whole, view, true, err);
}

bool figure_contact_area(const Page *whole, ResultView *view, Error *err)
{
    return contact_map(whole, view, false, err);
}

// Least, mean and largest of the contact area over the nodes that are shown.
bool figure_contact_area_table(const char *path, ResultView *view, const FieldChoice *field,
                               Error *err)
{
    (void)field;
    double *columns[OF_STATE] = {0};
    TRY(computed_area_read(view, err));
    TRY(result_view_read_status(view, err));
    for (int32_t k = 0; k < OF_STATE; ++k) TRY(columns[k] = NEW_ARRAY(double, view->rows, err));
    for (int64_t row = 0; row < view->rows; ++row) {
        double least = INFINITY, sum = 0, most = -INFINITY;
        for (int64_t k = row * view->nodes; k < (row + 1) * view->nodes; ++k) {
            double value = view->status[k] == STATUS_OPEN ? 0 : view->area[k];
            least = fmin(least, value);
            most = fmax(most, value);
            sum += value;
        }
        columns[0][row] = least;
        columns[1][row] = sum / view->nodes;
        columns[2][row] = most;
    }
    const Column data[] = {{"U", "m", view->U},
                           {"t", "s", view->t},
                           {"least area", NULL, columns[0]},
                           {"mean area", NULL, columns[1]},
                           {"largest area", NULL, columns[2]}};
    TRY(columns_write(path, data, 5, view->rows, view->si, err));
cleanup:
    memory_free_list((void *const *)columns, OF_STATE);
    return error_is_clean(err);
}
