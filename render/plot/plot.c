// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/plot/plot.h"

#include "base/memory.h"

#include <math.h>

bool plot_bar_ends(const Axes *axes, const PlotSeries *series, int32_t k, Point end[2])
{
    bool lying = axes->y.names != NULL;
    if (!series->low || !series->high) return false;
    double low = series->low[k], high = series->high[k];
    end[0] = lying ? axes_place(axes, low, series->y[k]) : axes_place(axes, series->x[k], low);
    end[1] = lying ? axes_place(axes, high, series->y[k]) : axes_place(axes, series->x[k], high);
    return isfinite(end[0].x + end[0].y + end[1].x + end[1].y);
}

static void panel_destroy(PlotPanel *panel)
{
    memory_free_all(panel->names, panel->map.x, panel->map.y, panel->map.value, panel->map.contour,
                    panel->map.open);
    for (int32_t k = 0; k < PLOT_SERIES_MAX; k++) {
        memory_free_all(panel->series[k].x, panel->series[k].y, panel->series[k].low,
                        panel->series[k].high);
    }
}

void plot_destroy(Plot *plot)
{
    panel_destroy(&plot->main);
    panel_destroy(&plot->inset);
    for (int32_t k = 0; k < plot->panel_count; k++) panel_destroy(&plot->panels[k]);
    memory_free_all(plot->panels, plot->computed);
    *plot = (Plot){0};
}
