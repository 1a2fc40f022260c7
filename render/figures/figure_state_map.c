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
    Window window;
    KeyEntry entries[2];
    double *states = NULL;
    bool largest = page.style.pixels && strcmp(page.style.pixels, "largest") == 0;
    MapPage map = {.sign = largest ? 1 : -1};
    TRY(window_find(view, &page.style, &window, err));
    TRY(result_view_read(view, SERIES_STATE, false, &states, err));
    TRY(state_scale(view, (const double[2]){window.low, window.high}, states, &page.style, &map.bar,
                    err));
    map.states = states;
    key_draw(&page, entries, map_page_key(view, &window, entries));
    TRY(map_page_draw(&page, view, (double[]){window.low, window.high}, &map, err));
    map_page_draw_frame(&page, view, &map);
cleanup:
    memory_free(states);
    map_page_destroy(&map);
    return error_is_clean(err);
}
