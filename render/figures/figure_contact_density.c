// SPDX-License-Identifier: GPL-2.0-or-later
// Figure 1(d): the normalised density of the real contact area, phi = max(0, 1 - |slip rate| / v_c)
// (the paper's Methods), in the last precursors before sliding. Where the block has lifted off it
// is 0 for another reason, which has its own colour.
#include "render/figures/figures.h"

#include "render/figures/map_page.h"
#include "render/view/zoom.h"

#include <math.h>

enum { RANGES = 5 };

static const double RANGE_LOW[RANGES] = {0.9, 0.75, 0.5, 0.25, 0};   // where the scale may start
typedef struct Precursors {
    double density_min;   // the least phi before sliding starts, where in contact
    bool open;   // some node has lifted off
} Precursors;

static Precursors precursors_look(const ResultView *view, const Zoom *zoom, double critical)
{
    Precursors seen = {.density_min = 1};
    for (int64_t row = 0; row < view->rows; ++row) {
        if (!(view->U[row] >= zoom->U_low && view->U[row] <= zoom->U_high)) continue;
        for (int64_t k = row * view->nodes; k < (row + 1) * view->nodes; ++k) {
            bool open = view->status[k] == 0;
            seen.open = seen.open || open;
            if (!open && view->U[row] < zoom->U_slide)
                seen.density_min = fmin(seen.density_min, 1 - fabs(view->slip_rate[k]) / critical);
        }
    }
    return seen;
}

bool figure_contact_density(const Page *whole, ResultView *view, Error *err)
{
    Page page = *whole;
    double critical = view->number[NUMBER_CRITICAL_VELOCITY];
    Zoom zoom = zoom_choose(view);
    Measured measured = {0};
    MapPage map = {.critical = critical,
                   .bar = {.high = 1, .falling = true, .label = "contact density ~{\u03c6}"}};
    if (!(critical > 0)) FAIL(err, ERROR_INPUT, FIGURE_NO_DENSITY);
    if (!zoom.found) {
        result_view_range(view, &zoom.U_low, &zoom.U_high);
        zoom.U_slide = INFINITY;
    }
    TRY(result_view_read_slip_rate(view, err));
    TRY(result_view_read_status(view, err));
    map.status = view->status;
    Precursors seen = precursors_look(view, &zoom, critical);

    // The precursors fill the scale: far below v_c they would hardly show between 0 and 1. In
    // sliding phi is below the scale, which the scale says.
    int32_t k = 0;
    while (k < RANGES - 1 && RANGE_LOW[k] > seen.density_min) ++k;
    map.bar.low = RANGE_LOW[k];

    map.bar.clipped = map.bar.low > 0;
    map.bar.neutral = seen.open ? "open" : NULL;
    map.bar.neutral_color = MAP_OPEN;
    if (!figure_contact_area_shows(view))   // else that figure has them
        TRY(measured_read(page.style.compare, MEASURED_AREA, view, &measured, err));
    KeyEntry entries[4] = {{KEY_LINE, INK, "front of slip"}};
    int32_t count = 1 + map_page_key(view, NULL, entries + 1);
    if (zoom.words[0]) entries[count++] = (KeyEntry){.words = zoom.words};
    key_draw(&page, entries, measured_key(&measured, KEY_RING, entries, count));
    TRY(map_page_draw(&page, view, (double[]){zoom.U_low, zoom.U_high}, &map, err));
    map_page_draw_front(&page, view, &map);
    map_page_draw_areas(&page, &measured, &map);
    if (zoom.found && page.zoom_name) map.axes.color = ZOOM_DENSITY;
    map_page_draw_frame(&page, view, &map);
cleanup:
    measured_destroy(&measured);
    map_page_destroy(&map);
    return error_is_clean(err);
}
