// SPDX-License-Identifier: GPL-2.0-or-later
// Lengths of precursors over the load ratio, as experiments show them: each at the load at which it
// began, with how far slip came from the trailing end in it. The curve is the farthest that slip
// had come by then, slow slip included.
#include "render/figures/cycle_colors.h"
#include "render/figures/figures.h"

#include "render/view/zoom.h"

#include <math.h>

enum { ENTRIES = 6 + CYCLE_KEYS };

static const double RIGHT_MARGIN = 10;   // points: half a number, and the name l_c
static const double HEADROOM = 1.02;   // of the load ratio

// Extent of the cycles that are shown.
typedef struct Extent {
    double top;   // the largest load ratio
    int32_t precursors, slidings;
} Extent;

// Discs are precursors, rings slidings, of the cycle that is chosen. page NULL: they are counted.
static void events_draw(const Page *page, const ResultView *view, const Axes *axes, Color color,
                        Extent *extent)
{
    for (int32_t k = 0; k < view->event_count; ++k) {
        double mu = NAN, length = NAN;
        bool sliding = view->events[k].kind == VIEW_LEADING;
        if (!computed_event(view, &view->events[k], &mu, &length)) continue;
        extent->top = fmax(extent->top, mu);
        *(sliding ? &extent->slidings : &extent->precursors) += 1;
        if (!page) continue;
        Point at = axes_place(axes, mu, length);
        draw_disc(page->canvas, color, at, KEY_RADIUS * page->point);
        if (sliding) draw_disc(page->canvas, PAPER, at, 0.6 * KEY_RADIUS * page->point);
    }
}

static bool find_extent(ResultView *view, Extent *extent, Error *err)
{
    int32_t asked = view->cycle, first = 0, last = 0;
    ViewCurve curve;
    zoom_cycles(view, &first, &last);
    for (int32_t k = first; k <= last; ++k) {
        computed_choose_cycle(view, k);
        if (!computed_curve(view, MEASURED_LENGTH, &curve, err)) break;
        if (curve.count > 0) extent->top = fmax(extent->top, curve.at[curve.count - 1]);
        events_draw(NULL, view, NULL, INK, extent);
    }
    computed_choose_cycle(view, asked);
    return error_is_clean(err);
}

static void key_of(Page *page, const ResultView *view, const Extent *extent,
                   const Measured *measured)
{
    KeyEntry entries[ENTRIES];
    CycleWords words;
    int32_t count = 0, first = 0, last = 0;
    Zoom zoom = zoom_choose(view);
    zoom_cycles(view, &first, &last);
    entries[count++] =
        (KeyEntry){KEY_LINE, last > first ? INK : FIGURE_CURVE, "farthest slip so far"};
    if (extent->precursors > 0)
        entries[count++] = (KeyEntry){KEY_DISC, INK, "length of a rapid precursor"};
    if (extent->slidings > 0)
        entries[count++] = (KeyEntry){KEY_RING, INK, last > first ? "slidings" : "sliding"};
    if (last > first)
        count = cycle_key(last, words, entries, count);
    else if (zoom.words[0])
        entries[count++] = (KeyEntry){.words = zoom.words};
    count = measured_key(measured, KEY_DISC, entries, count);
    if (measured->matched)
        entries[count++] = (KeyEntry){KEY_LINE, FIGURE_LEVEL, "to the precursor nearest in load"};
    key_draw(page, entries, count);
}

static bool cycles_draw(const Page *page, ResultView *view, const Axes *axes, Error *err)
{
    int32_t asked = view->cycle, first = 0, last = 0;
    ViewCurve curve;
    zoom_cycles(view, &first, &last);
    for (int32_t k = first; k <= last; ++k) {
        Color color = last > first ? cycle_color(k, last) : FIGURE_CURVE;
        Stroke stroke = {.color = color, .width = CURVE_WIDTH * page->point};
        computed_choose_cycle(view, k);
        if (!computed_curve(view, MEASURED_LENGTH, &curve, err)) break;
        axes_curve(page, axes, &stroke, curve.at, curve.value, curve.count);
        events_draw(page, view, axes, last > first ? color : INK, &(Extent){0});
    }
    computed_choose_cycle(view, asked);
    return error_is_clean(err);
}

static Axes axes_layout(const Page *page, const ResultView *view, double top,
                        const Measured *measured)
{
    double high = top > 0 ? top : 1;
    double length = view->number[NUMBER_LENGTH];
    for (int32_t k = 0; k < measured->count; ++k) high = fmax(high, measured->at[k]);
    high *= HEADROOM;
    Axes axes = {
        .x = {.high = high > 0 ? high : 1, .factor = 1, .label = FIGURE_MU},
        .y = {.high = length, .factor = 1 / length, .label = "length of slip ~{l} / ~{L}"}};
    axes_fit(page, &page->room, RIGHT_MARGIN, &axes);
    return axes;
}

bool figure_precursors(const Page *whole, ResultView *view, Error *err)
{
    Page page = *whole;
    Measured measured = {0};
    Extent extent = {0};
    bool first_loading = zoom_choose(view).cycle == 1;   // l_c is of the later cycles
    double critical = first_loading ? (double)NAN : view->number[NUMBER_L_C];
    Stroke dashed = dashed_stroke(&page, INK, 0.5);
    if (!(view->number[NUMBER_LENGTH] > 0))
        return REFUSE(err, "the result does not say how long the block is");
    if (!find_extent(view, &extent, err)) return false;
    if (!measured_read(page.style.compare, MEASURED_LENGTH, view, &measured, err)) return false;
    key_of(&page, view, &extent, &measured);
    Axes axes = axes_layout(&page, view, extent.top, &measured);
    if (isfinite(critical)) axes_level(&page, &axes, &dashed, critical, 1.6, "~{l}_{c}");
    if (cycles_draw(&page, view, &axes, err)) {
        // A line from each measured length to the event that it stands beside.
        Stroke stroke = {.color = FIGURE_LEVEL, .width = 0.5 * page.point};
        canvas_clip(page.canvas, &axes.box);
        for (int32_t k = 0; k < measured.count && measured.matched; ++k)
            if (isfinite(measured.computed[k]))
                draw_segment(page.canvas, &stroke,
                             axes_place(&axes, measured.at[k], measured.value[k]),
                             axes_place(&axes, measured.x[k], measured.computed[k]));
        canvas_clip(page.canvas, NULL);

        measured_draw(&page, &measured, &axes);
        axes_draw(&page, &axes);
    }
    measured_destroy(&measured);
    return error_is_clean(err);
}
