// SPDX-License-Identifier: GPL-2.0-or-later
// Area of the real contacts over that at rest, A(x, t)/A_0, against U and x, as it is seen by light
// that crosses a contact (Rubinstein, Cohen and Fineberg, Nature 430, 1005, 2004). Where friction
// ages it is the law's own measure, which the history holds; else the contact density phi. A front
// takes a few per cent of the area, so that the colours span what the precursors leave, but for one
// per cent at each end, and no line covers the front.
#include "render/figures/figures.h"

#include "base/memory.h"
#include "render/figures/color_scale.h"
#include "render/figures/map_page.h"
#include "render/figures/measured.h"
#include "render/view/zoom.h"

#include <math.h>
#include <string.h>

enum { COUNTED_MOST = 200000 };   // of a long history every second row, or third, ...

bool figure_contact_area_shows(const ResultView *view)
{
    return result_file_has_series(view->file, SERIES_AREA);
}

// Fits the bar to the area of what touches, from U[0] to U[1].
static bool fit_bar(const ResultView *view, const double U[2], const PictureStyle *style,
                    Colorbar *bar, Error *err)
{
    const ValueWords words = {.words = "contact area ~{A} / ~{A}_{0}", .si = "", .normalised = ""};
    int64_t total = view->rows * view->nodes, every = 1 + total / COUNTED_MOST, count = 0;
    WeighedValue *values = NEW_ARRAY(WeighedValue, total / every + view->nodes, err);
    TRY(values);
    for (int64_t row = 0; row < view->rows; row += every)
        for (int32_t i = 0; i < view->nodes && view->U[row] >= U[0] && view->U[row] <= U[1]; ++i)
            if (view->status[row * view->nodes + i] != 0)
                values[count++] = (WeighedValue){view->area[row * view->nodes + i], 1};
    TRY(value_bar_fit(values, count, &words, style, bar, err));
    bar->falling = true;
cleanup:
    memory_free(values);
    return error_is_clean(err);
}

bool figure_contact_area(const Page *whole, ResultView *view, Error *err)
{
    Page page = *whole;
    double *area = NULL;
    Measured measured = {0};
    ViewRange shown = {0};
    KeyEntry entries[4];
    Zoom zoom = zoom_choose(view);
    MapPage map = {.sign = -1};
    bool asked = page.style.from || page.style.to, open = false;

    // The range that is shown, and the part of it that the colours are for: sliding is darker than
    // any.
    TRY(view_range_find(view, &page.style, &shown, err));
    if (zoom.found && !asked) {
        shown.low = zoom.U_low;
        shown.high = zoom.U_high;
    }
    double calm[2] = {shown.low, shown.high};
    if (zoom.found && !asked && zoom.U_slide > shown.low) calm[1] = zoom.U_slide;
    TRY(result_view_read_status(view, err));
    TRY(computed_area_read(view, err));
    TRY(fit_bar(view, calm, &page.style, &map.bar, err));
    if (figure_contact_area_shows(view))
        TRY(measured_read(page.style.compare, MEASURED_AREA, view, &measured, err));
    TRY(area = NEW_ARRAY(double, view->rows * view->nodes, err));
    memcpy(area, view->area, (size_t)(view->rows * view->nodes) * sizeof *area);

    // Open contact has a colour of its own.
    for (int64_t k = 0; k < view->rows * view->nodes; ++k) {
        double U = view->U[k / view->nodes];
        if (view->status[k] != 0) continue;
        area[k] = -INFINITY;
        open = open || (U >= shown.low && U <= shown.high);
    }
    map.states = area;
    map.bar.clipped = map.bar.clipped || calm[1] < shown.high;   // in sliding less is left
    map.bar.neutral = open ? "open" : NULL;
    map.bar.neutral_color = MAP_OPEN;
    int32_t count = map_page_key(view, NULL, entries);
    if (!asked && zoom.words[0]) entries[count++] = (KeyEntry){.words = zoom.words};
    count = measured_key(&measured, KEY_RING, entries, count);
    key_draw(&page, entries, count);
    TRY(map_page_draw(&page, view, (double[]){shown.low, shown.high}, &map, err));
    map_page_draw_areas(&page, &measured, &map);
    map_page_draw_frame(&page, view, &map);
cleanup:
    measured_destroy(&measured);
    memory_free(area);
    map_page_destroy(&map);
    return error_is_clean(err);
}
