// SPDX-License-Identifier: GPL-2.0-or-later
// The map lies below, then lines, then error bars, then marks.
#include "render/plot/panel.h"

#include "render/plot/marks.h"

static const double BAR_WIDTH = 0.5, BAR_CAP = 1.4;   // points: error bars, half their caps

// From low to high with caps: upright, or lying where the y axis has names.
static void bars_draw(const Page *page, const Axes *axes, const PlotSeries *series)
{
    Stroke stroke = {.color = mark_color(series), .width = BAR_WIDTH * page->point};
    bool lying = axes->y.names != NULL;
    double cap_x = lying ? 0 : BAR_CAP * page->point, cap_y = lying ? BAR_CAP * page->point : 0;
    for (int32_t k = 0; k < series->count; ++k) {
        Point end[2];
        if (!plot_bar_ends(axes, series, k, end)) continue;
        draw_segment(page->canvas, &stroke, end[0], end[1]);
        for (int32_t side = 0; side < 2; ++side)
            draw_segment(page->canvas, &stroke, (Point){end[side].x - cap_x, end[side].y - cap_y},
                         (Point){end[side].x + cap_x, end[side].y + cap_y});
    }
}

// Lines and bars are cut off at the frame. A NaN breaks a line; so does what a logarithmic axis
// cannot show.
static void series_draw(const Page *page, const Axes *axes, const PlotPanel *panel, double share)
{
    for (int32_t k = 0; k < panel->series_count; ++k) {
        const PlotSeries *series = &panel->series[k];
        Stroke stroke = mark_stroke(page, series, share);
        if (series->line != LINE_NONE)
            axes_curve(page, axes, &stroke, series->x, series->y, series->count);
    }
    canvas_clip(page->canvas, &axes->box);
    for (int32_t k = 0; k < panel->series_count; ++k) bars_draw(page, axes, &panel->series[k]);
    canvas_clip(page->canvas, NULL);
    for (int32_t k = 0; k < panel->series_count; ++k) {
        // A mark on the frame is drawn whole, one beyond it not at all.
        const PlotSeries *series = &panel->series[k];
        for (int32_t i = 0; i < series->count; ++i) {
            Point at = axes_place(axes, series->x[i], series->y[i]);
            bool inside = at.x >= axes->box.left - 1 && at.x <= axes->box.right + 1 &&
                          at.y >= axes->box.top - 1 && at.y <= axes->box.bottom + 1;
            if (inside) mark_draw(page, series, at, share);
        }
    }
}

bool panel_draw(const Page *page, const PanelDef *def, const Axes *axes, Error *err)
{
    const PlotPanel *common = def->common;
    if (def->panel->has_map && !figure_map(page, axes, def->panel, def->scale, err)) return false;
    if (common && common->has_map && !figure_map(page, axes, common, def->scale, err)) return false;
    series_draw(page, axes, def->panel, def->share);
    if (common) series_draw(page, axes, common, def->share);
    axes_draw(page, axes);
    return true;
}
