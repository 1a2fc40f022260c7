// SPDX-License-Identifier: GPL-2.0-or-later
// How long slip is over the load ratio, as experiments show it; and each rapid precursor at the
// load at which it began, with the length that slip from the trailing end had in it: on the curve,
// or below it where slip had come farther before.
#include "render/figures/figures.h"

#include "render/view/zoom.h"

#include <math.h>

static const double RIGHT_MARGIN = 10;   // points: half a number, and the name l_c
static const double HEADROOM = 1.02;   // of the load ratio

// Each bounded precursor of the cycle; returns how many. page: NULL: they are counted.
static int32_t precursors_draw(const Page *page, ResultView *view, const Axes *axes)
{
    int32_t count = 0;
    Zoom zoom = zoom_choose(view);
    for (int32_t k = 0; k < view->event_count; ++k) {
        const ViewEvent *event = &view->events[k];
        double mu = NAN, length = NAN;
        Error ignored = {0};   // the curve has read the front
        bool inside = event->U_start >= zoom.U_start && event->U_start < zoom.U_slide;
        if (!inside || !computed_precursor(view, event, &mu, &length, &ignored)) continue;
        ++count;
        if (page)
            draw_disc(page->canvas, INK, axes_place(axes, mu, length), KEY_RADIUS * page->point);
    }
    return count;
}

static void key_of(Page *page, ResultView *view, int32_t precursors, const Measured *measured)
{
    KeyEntry entries[4] = {{KEY_LINE, FIGURE_CURVE, "farthest slip so far"},
                           {KEY_DISC, INK, "rapid precursor"}};
    int32_t count = 1 + (precursors > 0);
    Zoom zoom = zoom_choose(view);
    if (zoom.words[0]) entries[count++] = (KeyEntry){.words = zoom.words};
    key_draw(page, entries, measured_key(measured, KEY_DISC, entries, count));
}

// The largest load ratio of the cycles, and how many rapid precursors they have.
static bool find_extent(ResultView *view, double *top, int32_t *precursors, Error *err)
{
    int32_t asked = view->cycle, first = 0, last = 0;
    ViewCurve curve;
    *top = 0;
    *precursors = 0;
    zoom_cycles(view, &first, &last);
    for (int32_t k = first; k <= last; ++k) {
        computed_choose_cycle(view, k);
        if (!computed_curve(view, MEASURED_LENGTH, &curve, err)) break;
        if (curve.count > 0) *top = fmax(*top, curve.at[curve.count - 1]);
        *precursors += precursors_draw(NULL, view, NULL);
    }
    computed_choose_cycle(view, asked);
    return error_is_clean(err);
}

// Their curves and precursors.
static bool cycles_draw(const Page *page, ResultView *view, const Axes *axes, Error *err)
{
    int32_t asked = view->cycle, first = 0, last = 0;
    Stroke stroke = {.color = FIGURE_CURVE, .width = CURVE_WIDTH * page->point};
    ViewCurve curve;
    zoom_cycles(view, &first, &last);
    for (int32_t k = first; k <= last; ++k) {
        computed_choose_cycle(view, k);
        if (!computed_curve(view, MEASURED_LENGTH, &curve, err)) break;
        axes_curve(page, axes, &stroke, curve.at, curve.value, curve.count);
        precursors_draw(page, view, axes);
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
    int32_t precursors = 0;
    double critical = view->number[NUMBER_L_C], top = 0;
    Stroke dashed = dashed_stroke(&page, INK, 0.5);
    if (!(view->number[NUMBER_LENGTH] > 0))
        return REFUSE(err, "the result does not say how long the block is");
    if (!find_extent(view, &top, &precursors, err)) return false;
    if (!measured_read(page.style.compare, MEASURED_LENGTH, view, &measured, err)) return false;
    key_of(&page, view, precursors, &measured);
    Axes axes = axes_layout(&page, view, top, &measured);
    if (isfinite(critical)) axes_level(&page, &axes, &dashed, critical, 1.6, "~{l}_{c}");
    if (cycles_draw(&page, view, &axes, err)) {
        measured_draw(&page, &measured, &axes);
        axes_draw(&page, &axes);
    }
    measured_destroy(&measured);
    return error_is_clean(err);
}
