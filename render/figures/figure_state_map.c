// SPDX-License-Identifier: GPL-2.0-or-later
// State of friction with memory against U and x. Of all values in a pixel the smallest is shown, as
// slip makes contacts young at once and rest strengthens them slowly.
#include "render/figures/figures.h"

#include "base/memory.h"
#include "render/figures/map_page.h"
#include "render/figures/color_scale.h"

#include <math.h>
#include <string.h>

bool figure_state_map(const Page *whole, ResultView *view, Error *err)
{
    Page page = *whole;
    ViewRange shown;
    KeyEntry entries[2];
    double *states = NULL;
    bool largest = page.style.pixels && strcmp(page.style.pixels, "largest") == 0;
    MapPage map = {.sign = largest ? 1 : -1};
    TRY(view_range_find(view, &page.style, &shown, err));
    TRY(result_view_read(view, SERIES_STATE, false, &states, err));
    TRY(state_scale(view, (const double[2]){shown.low, shown.high}, states, &page.style, &map.bar,
                    err));
    map.states = states;
    key_draw(&page, entries, map_page_key(view, &shown, entries));
    TRY(map_page_draw(&page, view, (double[]){shown.low, shown.high}, &map, err));
    map_page_draw_frame(&page, view, &map);
cleanup:
    memory_free(states);
    map_page_destroy(&map);
    return error_is_clean(err);
}
