// SPDX-License-Identifier: GPL-2.0-or-later
// Figure 1(c): |slip rate| / V on a logarithmic scale, against U and x. What slips slower than the
// range shows is neutral: stick.
#include "render/figures/figures.h"

#include "render/figures/map_page.h"
#include "render/figures/color_scale.h"
#include "render/view/zoom.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

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
    int32_t count = map_page_key(view, &shown, entries);
    key_draw(&page, entries, measured_key(&measured, KEY_DISC, entries, count));

    TRY(map_page_draw(&page, view, (double[]){shown.low, shown.high}, &map, err));
    if (marked) zoom_draw(&page, &zoom, &map.axes);
    if (isfinite(length)) {
        // The critical length of the quasi-static precursor, as the paper's figure has it: a dashed
        // line.
        Stroke stroke = dashed_stroke(&page, INK, 0.6);
        axes_level(&page, &map.axes, &stroke, result_view_trailing_end(view) + length, 1.6,
                   "~{l}_{c}");
    }

    measured_draw(&page, &measured, &map.axes);
    map_page_draw_frame(&page, view, &map);
cleanup:
    measured_destroy(&measured);
    map_page_destroy(&map);
    return error_is_clean(err);
}
