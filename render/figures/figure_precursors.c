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

static void key_of(Page *page, ResultView *view, const Measured *measured)
{
    KeyEntry entries[3] = {{KEY_LINE, FIGURE_CURVE, "farthest slip so far"},
                           {KEY_DISC, INK, "rapid precursor"}};
    int32_t count = 1 + (precursors_draw(NULL, view, NULL) > 0);
    key_draw(page, entries, measured_key(measured, KEY_DISC, entries, count));
}

static Axes axes_layout(const Page *page, const ResultView *view, const ViewCurve *curve,
                        const Measured *measured)
{
    double high = curve->count > 0 ? curve->at[curve->count - 1] : 1;
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
    ViewCurve curve;
    Measured measured = {0};
    double critical = view->number[NUMBER_L_C];
    Stroke stroke = {.color = FIGURE_CURVE, .width = CURVE_WIDTH * page.point};
    Stroke dashed = dashed_stroke(&page, INK, 0.5);
    if (!(view->number[NUMBER_LENGTH] > 0))
        return REFUSE(err, "the result does not say how long the block is");
    if (!computed_curve(view, MEASURED_LENGTH, &curve, err)) return false;
    if (!measured_read(page.style.compare, MEASURED_LENGTH, view, &measured, err)) return false;
    key_of(&page, view, &measured);
    Axes axes = axes_layout(&page, view, &curve, &measured);
    if (isfinite(critical)) axes_level(&page, &axes, &dashed, critical, 1.6, "~{l}_{c}");
    axes_curve(&page, &axes, &stroke, curve.at, curve.value, curve.count);
    precursors_draw(&page, view, &axes);
    measured_draw(&page, &measured, &axes);
    axes_draw(&page, &axes);
    measured_destroy(&measured);
    return true;
}
