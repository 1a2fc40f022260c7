// SPDX-License-Identifier: GPL-2.0-or-later
// Figure 1(d): the normalised density of the real contact area, phi = max(0, 1 - |slip rate| / v_c)
// (the paper's Methods), 0 where the block has lifted off, in the last precursors before sliding.
#include "render/figures.h"

#include "render/map_page.h"
#include "render/zoom.h"

#include <math.h>

// From slip rates to 1 - phi: what is lost is what is to be seen. Open is infinitely fast here.
static void grid_to_levels(PixelGrid *grid, double critical)
{
    int64_t count = (int64_t)grid->rows * grid->columns;
    for (int64_t k = 0; k < count; ++k) {
        double rate = (double)grid->values[k];
        grid->values[k] = isnan(rate) ? HEAT_MISSING : (float)fmin(rate / critical, 1);
    }
}

bool figure_contact_density(const Page *page, ResultView *view, Error *err)
{
    double critical = view->number[NUMBER_CRITICAL_VELOCITY];
    Zoom zoom = zoom_choose(view);
    MapPage map = {
        .bar = {.low = 0, .high = 1, .falling = true, .label = "contact density ~{\u03c6}"}};
    if (!(critical > 0))
        FAIL(err, ERROR_INPUT,
             "the result has no critical velocity, which the contact density "
             "is defined by");
    if (!zoom.found) result_view_range(view, &zoom.U_low, &zoom.U_high);
    TRY(result_view_read_slip_rate(view, err));
    TRY(result_view_read_status(view, err));
    map_page_layout(page, view, zoom.U_low, zoom.U_high, &map);
    TRY(map_page_fill(view, view->status, &map, err));
    grid_to_levels(&map.grid, critical);
    map_page_draw_field(page, view, &map);
    TRY(map_page_draw_front(page, view, &map, err));
    if (zoom.found) map.axes.color = ZOOM_DENSITY;
    map_page_draw_frame(page, &map);
cleanup:
    map_page_destroy(&map);
    return error_is_clean(err);
}
