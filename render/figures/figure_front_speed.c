// SPDX-License-Identifier: GPL-2.0-or-later
// How fast fronts of the precursors and the sliding of a cycle run, over x, beside the speeds of
// waves.
#include "render/figures/cycle_colors.h"
#include "render/figures/figures.h"

#include "base/memory.h"
#include "render/view/zoom.h"

#include <math.h>
#include <stdio.h>

enum { ENTRIES = 11 + CYCLE_KEYS };

static const double RIGHT_MARGIN = 22;   // points: names of the waves' speeds
static const double HEADROOM = 1.08;   // frame's top over the largest speed
static const double OF_PRECURSOR = 0.6, OF_SLIDING = 0.8;   // radius of marks, over KEY_RADIUS

static const Color PRECURSOR = {0.85f, 0.47f, 0.10f, 1};

// Numbers of the fronts that are shown.
typedef struct Fronts {
    int32_t precursors, slidings;   // with a front that the steps resolve
    double fastest;   // velocity
    bool backwards;   // one ran towards the trailing end
} Fronts;

// Speeds by size, with a line between neighbours that ran the same way; a triangle that points left
// where the front ran towards the trailing end, a ring above the fastest wave.
static void front_draw(const Page *page, const Axes *axes, const ResultView *view,
                       const ViewCurve *curve, Color color, double radius)
{
    Stroke stroke = {.color = color, .width = CURVE_WIDTH * page->point};
    double fastest_wave = view->number[NUMBER_C_LONGITUDINAL];
    canvas_clip(page->canvas, &axes->box);
    for (int64_t k = 0; k < curve->count; ++k) {
        double speed = fabs(curve->value[k]), size = radius * KEY_RADIUS * page->point;
        Point at = axes_place(axes, curve->at[k], speed);
        if (k + 1 < curve->count && computed_speeds_join(view, curve, k))
            draw_segment(page->canvas, &stroke, at,
                         axes_place(axes, curve->at[k + 1], fabs(curve->value[k + 1])));
        if (curve->value[k] < 0)
            key_draw_back(page->canvas, color, at, size);
        else
            draw_disc(page->canvas, color, at, (speed > fastest_wave ? 1.5 : 1) * size);
        if (speed > fastest_wave) draw_disc(page->canvas, PAPER, at, 0.8 * size);
    }
    canvas_clip(page->canvas, NULL);
}

// The fronts of the precursors and of the sliding of the cycle that is chosen, of all rapid events
// where none has ended. axes NULL: they are counted.
static bool cycle_draw(const Page *page, const Axes *axes, ResultView *view, const Color color[2],
                       Fronts *fronts, Error *err)
{
    Zoom zoom = zoom_choose(view);
    for (int32_t k = 0; k < view->event_count; ++k) {
        const ViewEvent *event = &view->events[k];
        ViewCurve curve;
        bool sliding = event->kind == VIEW_LEADING;
        if (!view_event_counts(event) || !zoom_covers(&zoom, event->U_start)) continue;
        bool found = computed_front_speed(view, event, &curve, err);
        if (found && axes)
            front_draw(page, axes, view, &curve, color[sliding],
                       sliding ? OF_SLIDING : OF_PRECURSOR);
        for (int64_t i = 0; found && i < curve.count; ++i) {
            fronts->fastest = fmax(fronts->fastest, fabs(curve.value[i]));
            fronts->backwards = fronts->backwards || curve.value[i] < 0;
        }
        *(sliding ? &fronts->slidings : &fronts->precursors) += found && curve.count > 0;
        memory_free_all(curve.at, curve.value);
        if (!found) return false;
    }
    return true;
}

// The same of all cycles that are shown, each in its colour where these are several.
static bool fronts_draw(const Page *page, const Axes *axes, ResultView *view, Fronts *fronts,
                        Error *err)
{
    int32_t asked = view->cycle, first = 0, last = 0;
    zoom_cycles(view, &first, &last);
    for (int32_t k = first; k <= last && error_is_clean(err); ++k) {
        Color own = last > first ? cycle_color(k, last) : PRECURSOR;
        const Color colors[2] = {own, last > first ? own : FIGURE_CURVE};
        computed_choose_cycle(view, k);
        cycle_draw(page, axes, view, colors, fronts, err);
    }
    computed_choose_cycle(view, asked);
    return error_is_clean(err);
}

// A front of speeding up may be faster than any wave, and where viscosity damps every wave their
// speeds bound nothing: both are said.
static void key_of(Page *page, const ResultView *view, const Fronts *fronts,
                   const Measured *measured)
{
    char damped[80];
    const double *number = view->number;
    KeyEntry entries[ENTRIES];
    CycleWords words;
    int32_t count = 0, first = 0, last = 0;
    Zoom zoom = zoom_choose(view);
    zoom_cycles(view, &first, &last);
    bool several = last > first;
    if (fronts->slidings + fronts->precursors == 0) {
        entries[count++] = (KeyEntry){.words = "no front that the steps resolve:"};
        entries[count++] = (KeyEntry){.words = "time.accuracy: fine or a smaller time.wave_step"};
    }
    if (several) {
        entries[count++] = (KeyEntry){.words = "fronts of precursors (small) and slidings:"};
        count = cycle_key(last, words, entries, count);
    } else if (fronts->slidings > 0) {
        entries[count++] = (KeyEntry){KEY_LINE, FIGURE_CURVE, "front of the sliding"};
        if (zoom.found) entries[count++] = (KeyEntry){KEY_DASHED, INK, "slow slip ended here"};
    }
    if (!several && fronts->precursors > 0)
        entries[count++] = (KeyEntry){KEY_LINE, PRECURSOR, "fronts of precursors"};
    if (fronts->backwards)
        entries[count++] = (KeyEntry){KEY_BACK, INK, "runs towards the trailing end"};
    entries[count++] = (KeyEntry){KEY_DASHED, FIGURE_LEVEL,
                                  "waves of Rayleigh ~{c}_{R}, shear ~{c}_{S}, pressure ~{c}_{L}"};
    if (!several && zoom.words[0]) entries[count++] = (KeyEntry){.words = zoom.words};
    if (fronts->fastest > number[NUMBER_C_LONGITUDINAL])
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

bool figure_front_speed(const Page *whole, ResultView *view, Error *err)
{
    Page page = *whole;
    ViewCurve curve, front;
    Measured measured = {0};
    Fronts fronts = {0}, again = {0};
    const double *number = view->number;
    Stroke stroke = dashed_stroke(&page, FIGURE_LEVEL, 0.5);
    if (!(number[NUMBER_LENGTH] > 0 && number[NUMBER_C_RAYLEIGH] > 0 &&
          number[NUMBER_C_LONGITUDINAL] > 0))
        return REFUSE(err, "the result does not say how fast waves are");
    if (!fronts_draw(&page, NULL, view, &fronts, err)) return false;
    if (!measured_read(page.style.compare, MEASURED_SPEED, view, &measured, err)) return false;
    key_of(&page, view, &fronts, &measured);
    Axes axes = axes_layout(&page, view, fronts.fastest, &measured);
    axes_level(&page, &axes, &stroke, number[NUMBER_C_RAYLEIGH], 2, "~{c}_{R}");
    axes_level(&page, &axes, &stroke, number[NUMBER_C_SHEAR], 2, NULL);   // too near for a name
    axes_level(&page, &axes, &stroke, number[NUMBER_C_LONGITUDINAL], 2, "~{c}_{L}");
    TRY(fronts_draw(&page, &axes, view, &again, err));
    TRY(computed_curve(view, MEASURED_SPEED, &curve, err));
    TRY(computed_curve(view, MEASURED_FRONT, &front, err));
    if (curve.count > 0)
        slow_slip_draw(&page, &axes, curve_value(&front, zoom_choose(view).U_slide));
    measured_draw(&page, &measured, &axes);
    axes_draw(&page, &axes);
cleanup:
    measured_destroy(&measured);
    return error_is_clean(err);
}
