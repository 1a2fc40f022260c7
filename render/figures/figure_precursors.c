// SPDX-License-Identifier: GPL-2.0-or-later
// How long slip is over the load ratio, as experiments show it: l, from the trailing end to the
// farthest point that slip has come to since the sliding before, against the largest F_T/F_N since
// then; and each rapid precursor at the load at which it began.
#include "render/figures/figures.h"

#include "base/memory.h"
#include "render/canvas/key.h"
#include "render/view/zoom.h"

#include <math.h>

static const Color CURVE_COLOR = {0.05f, 0.27f, 0.55f, 1};
static const double RIGHT_MARGIN = 10;   // points: half a number, and the name l_c
static const double HEADROOM = 1.02;   // of the load ratio

// The rows of the cycle: from the shortest front behind the sliding before to the next one.
static void cycle_rows(const ResultView *view, const Zoom *zoom, int64_t *first, int64_t *end)
{
    double least = INFINITY;
    *first = 0;
    *end = view->rows;
    for (int64_t row = 0; zoom->found && row < view->rows; ++row) {
        double U = view->U[row];
        if (U > zoom->U_slide) {
            *end = row;
            return;
        }
        if (U >= zoom->U_start && view->front[row] <= least) {
            least = view->front[row];
            if (view->mu[row] <= view->mu[*first] || *first == 0) *first = row;
        }
    }
}

bool precursors_compute(ResultView *view, Error *err)
{
    ViewCurve *curve = &view->precursors;
    int64_t first = 0, end = 0;
    double mu = -INFINITY, length = 0;
    Zoom zoom = zoom_choose(view);
    if (curve->at) return true;
    TRY(result_view_read_front(view, err));
    cycle_rows(view, &zoom, &first, &end);
    TRY(curve->at = NEW_ARRAY(double, view->rows, err));
    TRY(curve->value = NEW_ARRAY(double, view->rows, err));
    for (int64_t row = first; row < end; ++row) {
        if (!isfinite(view->mu[row] + view->front[row])) continue;
        mu = fmax(mu, view->mu[row]);
        length = fmax(length, view->front[row] - figure_trailing_end(view));
        curve->at[curve->count] = mu;
        curve->value[curve->count++] = length;
    }
cleanup:
    return error_is_clean(err);
}

bool figure_precursors_measured(ResultView *view, const char *path, Measured *measured, Error *err)
{
    TRY(measured_read(path, MEASURED_LENGTH, view, measured, err));
    if (measured->count > 0) TRY(precursors_compute(view, err));
    measured_compare(measured, view, computed_on_curve, &view->precursors);
cleanup:
    return error_is_clean(err);
}

// F_T/F_N when the rod was at U.
static double mu_at(const ResultView *view, double U)
{
    const ViewCurve mu = {view->rows, view->U, view->mu};
    return curve_value(&mu, U);
}

// Each bounded precursor of the cycle; returns how many.
static int32_t precursors_draw(const Page *page, const ResultView *view, const Zoom *zoom,
                               const Axes *axes)
{
    int32_t count = 0;
    for (int32_t k = 0; k < view->event_count; ++k) {
        const ViewEvent *event = &view->events[k];
        bool inside = event->U_start >= zoom->U_start && event->U_start < zoom->U_slide;
        if (event->kind != VIEW_BOUNDED || !inside) continue;
        ++count;
        if (!page) continue;
        Point at =
            axes_place(axes, mu_at(view, event->U_start), event->reach - figure_trailing_end(view));
        draw_disc(page->canvas, INK, at, KEY_RADIUS * page->point);
    }
    return count;
}

static void key_of(Page *page, bool precursors, const Measured *measured)
{
    KeyEntry entries[3] = {{KEY_LINE, CURVE_COLOR, "farthest slip so far"}};
    int32_t count = 1;
    if (precursors) entries[count++] = (KeyEntry){KEY_DISC, INK, "rapid precursor"};
    if (measured->count > 0)
        entries[count++] = (KeyEntry){KEY_DISC, MEASURED_COLOR, measured->words};
    key_draw(page, entries, count);
}

static Axes axes_layout(const Page *page, const ResultView *view, const Measured *measured)
{
    const ViewCurve *curve = &view->precursors;
    double high = curve->count > 0 ? curve->at[curve->count - 1] : 1, point = page->point;
    double length = view->number[NUMBER_LENGTH];
    Axes axes = {.number_size = NUMBER_SIZE, .color = INK};
    for (int32_t k = 0; k < measured->count; ++k) high = fmax(high, measured->at[k]);
    axes.x = (Axis){.high = HEADROOM * high, .factor = 1, .label = "~{F}_{T} / ~{F}_{N}"};
    axes.y = (Axis){.high = length, .factor = 1 / length, .label = "length of slip ~{l} / ~{L}"};
    if (!(axes.x.high > 0)) axes.x.high = 1;
    axes.box.top = page->room.top + round(axes_top_margin(&axes) * point);
    axes.box.bottom = round(page->room.bottom - axes_bottom_margin(&axes) * point);
    axes.box.left = round(page->room.left + axes_left_margin(page, &axes) * point);
    axes.box.right = round(page->room.right - RIGHT_MARGIN * point);
    page_place_frame(page, &axes.box);
    return axes;
}

static void critical_length_draw(const Page *page, const Axes *axes, double length)
{
    Stroke stroke = {.color = INK, .width = 0.5 * page->point, .dash = 3 * page->point};
    TextStyle style = {.size = NUMBER_SIZE * page->point, .color = INK, .up = 0.5};
    stroke.space = 2 * page->point;
    if (!isfinite(length)) return;
    Point from = axes_place(axes, axes->x.low, length), to = axes_place(axes, axes->x.high, length);
    draw_segment(page->canvas, &stroke, from, to);
    text_draw(page->text, &style, (Point){to.x + 1.6 * page->point, to.y}, "~{l}_{c}");
}

static bool line_draw(const Page *page, const Axes *axes, const ViewCurve *curve, Error *err)
{
    Stroke stroke = {.color = CURVE_COLOR, .width = CURVE_WIDTH * page->point};
    Point *line = NEW_ARRAY(Point, curve->count, err);
    if (!line) return false;
    for (int64_t k = 0; k < curve->count; ++k)
        line[k] = axes_place(axes, curve->at[k], curve->value[k]);
    canvas_clip(page->canvas, &axes->box);
    draw_line(page->canvas, &stroke, line, curve->count);
    canvas_clip(page->canvas, NULL);
    memory_free(line);
    return true;
}

bool figure_precursors(const Page *whole, ResultView *view, Error *err)
{
    Page page = *whole;
    Measured measured = {0};
    Zoom zoom = zoom_choose(view);
    if (!(view->number[NUMBER_LENGTH] > 0))
        FAIL(err, ERROR_INPUT, "the result does not say how long the block is");
    TRY(precursors_compute(view, err));
    TRY(figure_precursors_measured(view, page.style.compare, &measured, err));
    key_of(&page, precursors_draw(NULL, view, &zoom, NULL) > 0, &measured);
    Axes axes = axes_layout(&page, view, &measured);
    critical_length_draw(&page, &axes, view->number[NUMBER_L_C]);
    TRY(line_draw(&page, &axes, &view->precursors, err));
    precursors_draw(&page, view, &zoom, &axes);
    measured_draw(&page, &measured, &axes);
    axes_draw(&page, &axes);
cleanup:
    measured_destroy(&measured);
    return error_is_clean(err);
}
