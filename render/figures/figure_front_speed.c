// SPDX-License-Identifier: GPL-2.0-or-later
// How fast fronts of the precursors and the sliding of a cycle run, over x, beside the speeds of
// waves.
#include "render/figures/figures.h"

#include "base/memory.h"
#include "render/view/zoom.h"

#include <math.h>
#include <stdio.h>

static const double RIGHT_MARGIN = 22;   // points: names of the waves' speeds
static const double HEADROOM = 1.08;   // frame's top over the largest speed

static const Color PRECURSOR = {0.85f, 0.47f, 0.10f, 1};

// Draws the fronts of the precursors of the cycle; where all cycles are shown, or none has ended,
// of all rapid events that count. Returns how many have one that the steps resolve. *fastest: rises
// to the largest of their speeds. axes: NULL: they are counted.
static int32_t fronts_draw(const Page *page, const Axes *axes, ResultView *view, double *fastest,
                           Error *err)
{
    Zoom zoom = zoom_choose(view);
    Stroke stroke = {.color = PRECURSOR, .width = CURVE_WIDTH * page->point};
    int32_t count = 0;
    for (int32_t k = 0; k < view->event_count; ++k) {
        const ViewEvent *event = &view->events[k];
        ViewCurve curve;
        bool bounded = event->kind == VIEW_BOUNDED, sliding = event->kind == VIEW_LEADING;
        bool inside = event->U_start >= zoom.U_start && event->U_start < zoom.U_slide;
        if (!(zoom.found ? bounded && inside : bounded || sliding)) continue;
        bool found = computed_front_speed(view, event, &curve, err);
        if (found && axes) axes_curve(page, axes, &stroke, curve.at, curve.value, curve.count);
        for (int64_t i = 0; found && i < curve.count; ++i) {
            *fastest = fmax(*fastest, curve.value[i]);
            if (!axes) continue;
            bool faster = curve.value[i] > view->number[NUMBER_C_LONGITUDINAL];
            Point at = axes_place(axes, curve.at[i], curve.value[i]);
            draw_disc(page->canvas, PRECURSOR, at, (faster ? 1 : 0.6) * KEY_RADIUS * page->point);
            if (faster) draw_disc(page->canvas, PAPER, at, 0.55 * KEY_RADIUS * page->point);
        }
        count += found && curve.count > 0;
        memory_free_all(curve.at, curve.value);
        if (!found) return 0;
    }
    return count;
}

// A front of speeding up may be faster than any wave, and where viscosity damps every wave their
// speeds bound nothing: both are said.
static void key_of(Page *page, const ViewCurve *curve, ResultView *view, int32_t fronts,
                   double fastest, const Measured *measured)
{
    char damped[80];
    const double *number = view->number;
    Zoom zoom = zoom_choose(view);
    KeyEntry entries[10] = {{.words = "no front of a sliding that the steps resolve:"}};
    int32_t count = 1;
    if (curve->count > 0) {
        entries[0] = (KeyEntry){KEY_LINE, FIGURE_CURVE, "front of the sliding"};
        entries[count++] = (KeyEntry){KEY_DASHED, INK, "slow slip ended here"};
    } else if (fronts > 0) {
        count = 0;
    } else {
        entries[count++] = (KeyEntry){.words = "time.accuracy: fine or a smaller time.wave_step"};
    }
    if (fronts > 0)
        entries[count++] = (KeyEntry){
            KEY_LINE, PRECURSOR, zoom.found ? "fronts of precursors" : "fronts of rapid events"};
    entries[count++] = (KeyEntry){KEY_DASHED, FIGURE_LEVEL,
                                  "waves of Rayleigh ~{c}_{R}, shear ~{c}_{S}, pressure ~{c}_{L}"};
    if (zoom.words[0]) entries[count++] = (KeyEntry){.words = zoom.words};
    if (fastest > number[NUMBER_C_LONGITUDINAL])
        entries[count++] =
            (KeyEntry){KEY_RING, FIGURE_CURVE, "faster than ~{c}_{L}: no wave carries it"};
    if (number[NUMBER_WAVE_DAMPING] > 1) {
        snprintf(damped, sizeof damped, "with %.2g times its eta1 and eta2 or less they would run",
                 1 / number[NUMBER_WAVE_DAMPING]);
        entries[count++] = (KeyEntry){.words = "viscosity damps every wave of this block;"};
        entries[count++] = (KeyEntry){.words = damped};
    }
    key_draw(page, entries, measured_key(measured, KEY_DISC, entries, count));
}

static Axes axes_layout(const Page *page, const ResultView *view, double fastest,
                        const Measured *measured)
{
    double length = view->number[NUMBER_LENGTH], low = result_view_trailing_end(view);
    double high = fmax(view->number[NUMBER_C_LONGITUDINAL], fastest);
    for (int32_t k = 0; k < measured->count; ++k) high = fmax(high, measured->value[k]);
    Axes axes = {.x = {low, low + length, 1 / length, .label = "~{x} / ~{L}"},
                 .y = {.high = high * HEADROOM,
                       .factor = 1 / view->number[NUMBER_C_RAYLEIGH],
                       .label = "front speed ~{v} / ~{c}_{R}"}};
    axes_fit(page, &page->room, RIGHT_MARGIN, &axes);
    return axes;
}

// How far slow slip had come before: a line upright.
static void slow_slip_draw(const Page *page, const Axes *axes, double x)
{
    Stroke stroke = dashed_stroke(page, INK, CURVE_WIDTH);
    draw_segment(page->canvas, &stroke, axes_place(axes, x, axes->y.low),
                 axes_place(axes, x, axes->y.high));
}

static void curve_draw(const Page *page, const Axes *axes, const ViewCurve *curve,
                       double wave_speed)
{
    Stroke stroke = {.color = FIGURE_CURVE, .width = CURVE_WIDTH * page->point};
    axes_curve(page, axes, &stroke, curve->at, curve->value, curve->count);
    canvas_clip(page->canvas, &axes->box);
    for (int64_t k = 0; k < curve->count; ++k) {
        Point at = axes_place(axes, curve->at[k], curve->value[k]);
        bool faster = curve->value[k] > wave_speed;
        draw_disc(page->canvas, FIGURE_CURVE, at, (faster ? 1.2 : 0.8) * KEY_RADIUS * page->point);
        if (faster) draw_disc(page->canvas, PAPER, at, 0.7 * KEY_RADIUS * page->point);
    }
    canvas_clip(page->canvas, NULL);
}

bool figure_front_speed(const Page *whole, ResultView *view, Error *err)
{
    Page page = *whole;
    ViewCurve curve, front;
    Measured measured = {0};
    const double *number = view->number;
    double fastest = 0;
    Stroke stroke = dashed_stroke(&page, FIGURE_LEVEL, 0.5);
    if (!(number[NUMBER_LENGTH] > 0 && number[NUMBER_C_RAYLEIGH] > 0 &&
          number[NUMBER_C_LONGITUDINAL] > 0))
        return REFUSE(err, "the result does not say how fast waves are");
    if (!computed_curve(view, MEASURED_SPEED, &curve, err)) return false;
    if (!computed_curve(view, MEASURED_FRONT, &front, err)) return false;
    if (!measured_read(page.style.compare, MEASURED_SPEED, view, &measured, err)) return false;
    int32_t fronts = fronts_draw(&page, NULL, view, &fastest, err);
    for (int64_t k = 0; k < curve.count; ++k) fastest = fmax(fastest, curve.value[k]);
    key_of(&page, &curve, view, fronts, fastest, &measured);
    Axes axes = axes_layout(&page, view, fastest, &measured);
    axes_level(&page, &axes, &stroke, number[NUMBER_C_RAYLEIGH], 2, "~{c}_{R}");
    axes_level(&page, &axes, &stroke, number[NUMBER_C_SHEAR], 2, NULL);   // too near for a name
    axes_level(&page, &axes, &stroke, number[NUMBER_C_LONGITUDINAL], 2, "~{c}_{L}");
    fronts_draw(&page, &axes, view, &fastest, err);
    if (curve.count > 0)
        slow_slip_draw(&page, &axes, curve_value(&front, zoom_choose(view).U_slide));
    curve_draw(&page, &axes, &curve, number[NUMBER_C_LONGITUDINAL]);
    measured_draw(&page, &measured, &axes);
    axes_draw(&page, &axes);
    measured_destroy(&measured);
    return error_is_clean(err);
}
