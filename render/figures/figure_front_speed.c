// SPDX-License-Identifier: GPL-2.0-or-later
// How fast the front of a sliding runs, over x: between stations a twentieth of the block apart, by
// the times at which slip there first gets faster than twice the rod, as in record/front_path.
// Where slip was slow before the front is one of speeding up, and may run faster than any wave.
#include "render/figures/figures.h"

#include "base/memory.h"
#include "render/canvas/key.h"
#include "render/view/zoom.h"

#include <math.h>

enum { STATIONS = 21 };

static const double RAPID = 2;   // slip rate over V (record/events)
static const double RIGHT_MARGIN = 22;   // points: names of the waves' speeds
static const double MOST_SHOWN = 3;   // times the fastest wave: beyond it arrivals are one step's
static const Color CURVE_COLOR = {0.05f, 0.27f, 0.55f, 1};
static const Color LEVEL_COLOR = {0.45f, 0.45f, 0.47f, 1};

// When node i first slipped so fast, from row `first` to the one before `end`; NaN: it did not.
static double arrival(const ResultView *view, int32_t i, int64_t first, int64_t end, double rapid)
{
    for (int64_t row = first; row < end; ++row) {
        double now = fabs(view->slip_rate[row * view->nodes + i]);
        if (!(now >= rapid)) continue;
        double before = row > 0 ? fabs(view->slip_rate[(row - 1) * view->nodes + i]) : now;
        double part = now > before ? fmin((rapid - before) / (now - before), 1) : 1;
        return row > 0 ? view->t[row] - (1 - fmax(part, 0)) * (view->t[row] - view->t[row - 1])
                       : view->t[row];
    }
    return NAN;
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

static void event_rows(const ResultView *view, const Zoom *zoom, int64_t *first, int64_t *end)
{
    double stop = INFINITY;
    for (int32_t k = 0; k < view->event_count; ++k)
        if (view->events[k].U_start == zoom->U_slide) stop = view->events[k].U_stop;
    *first = *end = 0;
    for (int64_t row = 0; row < view->rows; ++row) {
        if (view->U[row] < zoom->U_slide) *first = row;
        if (view->U[row] <= stop) *end = row + 1;
    }
}

bool front_speed_compute(ResultView *view, Error *err)
{
    ViewCurve *curve = &view->front_speed;
    double *times = NULL, V = fabs(view->number[NUMBER_ROD_VELOCITY]);
    int64_t first = 0, end = 0;
    Zoom zoom = zoom_choose(view);
    if (curve->at || !zoom.found) return true;
    TRY(result_view_read_slip_rate(view, err));
    TRY(times = NEW_ARRAY(double, view->nodes, err));
    TRY(curve->at = NEW_ARRAY(double, STATIONS, err));
    TRY(curve->value = NEW_ARRAY(double, STATIONS, err));
    event_rows(view, &zoom, &first, &end);
    for (int32_t i = 0; i < view->nodes; ++i) times[i] = arrival(view, i, first, end, RAPID * V);
    double low = view->x[0], step = (view->x[view->nodes - 1] - low) / (STATIONS - 1);
    for (int32_t k = 0; k + 1 < STATIONS; ++k) {
        double took = arrival_at(view, times, low + (k + 1) * step) -
                      arrival_at(view, times, low + k * step);
        if (!(step / fabs(took) < MOST_SHOWN * view->number[NUMBER_C_LONGITUDINAL])) continue;
        curve->at[curve->count] = low + (k + 0.5) * step;
        curve->value[curve->count++] = step / fabs(took);
    }
cleanup:
    memory_free(times);
    return error_is_clean(err);
}

bool figure_front_speed_measured(ResultView *view, const char *path, Measured *measured, Error *err)
{
    TRY(measured_read(path, MEASURED_SPEED, view, measured, err));
    if (measured->count > 0) TRY(front_speed_compute(view, err));
    measured_compare(measured, view, computed_on_curve, &view->front_speed);
cleanup:
    return error_is_clean(err);
}

static Axes axes_layout(const Page *page, const ResultView *view, const Measured *measured)
{
    const ViewCurve *curve = &view->front_speed;
    double length = view->number[NUMBER_LENGTH], rayleigh = view->number[NUMBER_C_RAYLEIGH];
    double fastest = view->number[NUMBER_C_LONGITUDINAL], high = fastest, point = page->point;
    Axes axes = {.number_size = NUMBER_SIZE, .color = INK};
    for (int64_t k = 0; k < curve->count; ++k) high = fmax(high, curve->value[k]);
    for (int32_t k = 0; k < measured->count; ++k) high = fmax(high, measured->value[k]);
    high *= 1.08;
    axes.x = (Axis){.low = figure_trailing_end(view), .factor = 1 / length, .label = "~{x} / ~{L}"};
    axes.x.high = axes.x.low + length;
    axes.y = (Axis){.high = high, .factor = 1 / rayleigh, .label = "front speed ~{v} / ~{c}_{R}"};
    axes.box.top = page->room.top + round(axes_top_margin(&axes) * point);
    axes.box.bottom = round(page->room.bottom - axes_bottom_margin(&axes) * point);
    axes.box.left = round(page->room.left + axes_left_margin(page, &axes) * point);
    axes.box.right = round(page->room.right - RIGHT_MARGIN * point);
    page_place_frame(page, &axes.box);
    return axes;
}

static void waves_draw(const Page *page, const ResultView *view, const Axes *axes)
{
    static const struct {
        ResultNumber number;
        const char *name;
    } waves[2] = {{NUMBER_C_RAYLEIGH, "~{c}_{R}"}, {NUMBER_C_LONGITUDINAL, "~{c}_{L}"}};
    Stroke stroke = {.color = LEVEL_COLOR, .width = 0.5 * page->point, .dash = 3 * page->point};
    TextStyle style = {.size = NUMBER_SIZE * page->point, .color = INK, .up = 0.5};
    stroke.space = 2 * page->point;
    for (int32_t k = 0; k < 2; ++k) {
        double speed = view->number[waves[k].number];
        Point from = axes_place(axes, axes->x.low, speed),
              to = axes_place(axes, axes->x.high, speed);
        draw_segment(page->canvas, &stroke, from, to);
        text_draw(page->text, &style, (Point){to.x + 2 * page->point, to.y}, waves[k].name);
    }
}

// How far slow slip had come before: a line upright.
static void slow_slip_draw(const Page *page, const Axes *axes, double x)
{
    Stroke stroke = {.color = INK, .width = CURVE_WIDTH * page->point, .dash = 3 * page->point};
    stroke.space = 2 * page->point;
    draw_segment(page->canvas, &stroke, axes_place(axes, x, axes->y.low),
                 axes_place(axes, x, axes->y.high));
}

static void curve_draw(const Page *page, const Axes *axes, const ViewCurve *curve)
{
    Stroke stroke = {.color = CURVE_COLOR, .width = CURVE_WIDTH * page->point};
    Point line[STATIONS];
    for (int64_t k = 0; k < curve->count; ++k)
        line[k] = axes_place(axes, curve->at[k], curve->value[k]);
    canvas_clip(page->canvas, &axes->box);
    draw_line(page->canvas, &stroke, line, curve->count);
    for (int64_t k = 0; k < curve->count; ++k)
        draw_disc(page->canvas, CURVE_COLOR, line[k], 0.8 * KEY_RADIUS * page->point);
    canvas_clip(page->canvas, NULL);
}

bool figure_front_speed(const Page *whole, ResultView *view, Error *err)
{
    Page page = *whole;
    Measured measured = {0};
    if (!(view->number[NUMBER_LENGTH] > 0 && view->number[NUMBER_C_RAYLEIGH] > 0 &&
          view->number[NUMBER_C_LONGITUDINAL] > 0))
        FAIL(err, ERROR_INPUT, "the result does not say how fast waves are");
    TRY(front_speed_compute(view, err));
    TRY(result_view_read_front(view, err));
    TRY(figure_front_speed_measured(view, page.style.compare, &measured, err));
    KeyEntry entries[3] = {{.words = "no front of a sliding that the steps resolve"}};
    int32_t count = 1;
    if (view->front_speed.count > 0) {
        entries[0] = (KeyEntry){KEY_LINE, CURVE_COLOR, "front of the sliding"};
        entries[count++] = (KeyEntry){KEY_DASHED, INK, "slow slip ended here"};
    }
    if (measured.count > 0) entries[count++] = (KeyEntry){KEY_DISC, MEASURED_COLOR, measured.words};
    key_draw(&page, entries, count);
    Axes axes = axes_layout(&page, view, &measured);
    const ViewCurve front = {view->rows, view->U, view->front};
    waves_draw(&page, view, &axes);
    if (view->front_speed.count > 0)
        slow_slip_draw(&page, &axes, curve_value(&front, zoom_choose(view).U_slide));
    curve_draw(&page, &axes, &view->front_speed);
    measured_draw(&page, &measured, &axes);
    axes_draw(&page, &axes);
cleanup:
    measured_destroy(&measured);
    return error_is_clean(err);
}
