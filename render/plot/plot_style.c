// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/plot/plot_style.h"

#include "base/memory.h"
#include "base/order.h"
#include "io/text/picture_options.h"
#include "render/plot/plot_file.h"

#include <math.h>
#include <stdlib.h>

// The values of all maps, sorted: [*count], the caller's.
static bool sort_values(const Plot *plot, double **sorted, int64_t *count, Error *err)
{
    int64_t all = plot->main.map.count;
    *count = 0;
    for (int32_t k = 0; k < plot->panel_count; k++) all += plot->panels[k].map.count;
    if (!(*sorted = NEW_ARRAY(double, all, err))) return false;
    for (int32_t k = -1; k < plot->panel_count; k++) {
        const PlotMap *map = k < 0 ? &plot->main.map : &plot->panels[k].map;
        for (int32_t i = 0; i < map->count; i++)
            if (isfinite(map->value[i])) (*sorted)[(*count)++] = map->value[i];
    }
    qsort(*sorted, (size_t)*count, sizeof **sorted, order_doubles);
    return true;
}

bool plot_take_style(Plot *plot, const PictureStyle *style, Error *err)
{
    double *sorted = NULL, *end[2] = {&plot->color.low, &plot->color.high};
    int64_t count = 0;
    if (style->legend) plot->main.legend = plot_corner_find(style->legend);
    if (!style->limits) return true;
    TRY(sort_values(plot, &sorted, &count, err));
    for (int32_t k = 0; k < 2 && count > 0; k++) {
        bool is_part = false;
        double limit = picture_limit(style, k, &is_part);
        *end[k] = is_part ? sorted[llround(limit * (double)(count - 1))]
                          : limit / plot->color.factor;
    }
cleanup:
    memory_free(sorted);
    return error_is_clean(err);
}
