// SPDX-License-Identifier: GPL-2.0-or-later
// One frame, perhaps with an inset, or a page of frames (plot_grid); the legend where the file or
// legend_place puts it.
#include "render/plot/figure_curves.h"

#include "base/memory.h"
#include "base/order.h"
#include "render/picture_options.h"
#include "render/plot/legend.h"
#include "render/plot/panel.h"
#include "render/plot/plot_compare.h"
#include "render/plot/plot_file.h"
#include "render/plot/plot_grid.h"
#include "render/render.h"

#include <math.h>
#include <stdlib.h>

static const double RIGHT_MARGIN = 6, POWER_MARGIN = 9;   // points: half a number may stand there
static const double BELOW_MARGIN = 6;   // points beside a legend below
static const double BAR_GAP = 6;   // points: frame to colour bar
static const double INSET_SHARE = 0.75;   // marks and lines of an inset over the main ones

// From parts of the frame to pixels.
static Box inset_place(const Plot *plot, const Box *frame)
{
    double width = frame->right - frame->left, height = frame->bottom - frame->top;
    return (Box){.left = frame->left + plot->place[0] * width,
                 .top = frame->top + plot->place[1] * height,
                 .right = frame->left + plot->place[2] * width,
                 .bottom = frame->top + plot->place[3] * height};
}

// The inset's frame is what is left of its place when its numbers and names have their room.
static Axes inset_axes(const Page *page, const Plot *plot, const Box *frame)
{
    Axes axes = {
        .box = inset_place(plot, frame), .x = plot->inset.x, .y = plot->inset.y, .small = true};
    axes.box.left = round(axes.box.left + axes_left_margin(page, &axes) * page->point);
    axes.box.bottom = round(axes.box.bottom - axes_bottom_margin(&axes) * page->point);
    axes.box.right = round(axes.box.right);
    axes.box.top = round(axes.box.top);
    return axes;
}

// The inset covers what lies below it: its place is cleared to paper first.
static bool inset_draw(const Page *page, const Plot *plot, const MapScale *scale, const Box *frame,
                       Error *err)
{
    Axes axes = inset_axes(page, plot, frame);
    Box place = inset_place(plot, frame);
    PanelDef def = {.panel = &plot->inset, .scale = scale, .share = INSET_SHARE};
    draw_fill(page->canvas, PAPER, &place);
    Box legend = legend_settle(page, &plot->inset, INSET_SHARE, NULL, &axes);
    if (!panel_draw(page, &def, &axes, err)) return false;
    legend_draw(page, &axes, &plot->inset, &legend, INSET_SHARE);
    return true;
}

// The frame above `bottom`, with room for what stands beside it.
static Axes frame_axes(const Page *page, const Plot *plot, const MapScale *scale, double bottom)
{
    double right = plot->main.x.is_log ? POWER_MARGIN : RIGHT_MARGIN;
    Axes axes = {.x = plot->main.x, .y = plot->main.y};
    Box room = page->room;
    room.bottom = bottom;
    if (plot->main.has_map) right = BAR_GAP + colorbar_width(page, &scale->bar);
    axes_fit(page, &room, right, &axes);
    return axes;
}

// axes: from frame_axes, narrowed by a legend beside them.
static bool one_frame(const Page *page, const Plot *plot, Axes *axes, bool legend_is_elsewhere,
                      Error *err)
{
    MapScale scale = map_scale_fit(plot);
    PanelDef def = {.panel = &plot->main, .scale = &scale, .share = 1};
    Box place = inset_place(plot, &axes->box), legend = {0};
    if (!legend_is_elsewhere)
        legend = legend_settle(page, &plot->main, 1, plot->has_inset ? &place : NULL, axes);
    if (!panel_draw(page, &def, axes, err)) return false;
    legend_draw(page, axes, &plot->main, &legend, 1);
    if (plot->main.has_map) colorbar_draw(page, &scale.bar, &axes->box, BAR_GAP);
    if (plot->has_inset && !inset_draw(page, plot, &scale, &axes->box, err)) return false;
    return true;
}

bool figure_curves(const Page *page, const Plot *plot, Error *err)
{
    double margin = BELOW_MARGIN * page->point, bottom = page->room.bottom;
    MapScale scale = map_scale_fit(plot);
    Axes axes = frame_axes(page, plot, &scale, bottom);
    Box below = {margin, bottom, canvas_width(page->canvas) - margin, bottom};
    bool is_below = legend_is_below(page, plot, &axes);
    if (is_below) {
        below.top -= round(legend_below_height(page, &plot->main, &below));
        axes = frame_axes(page, plot, &scale, below.top);
    }
    if (!(plot->panel_count > 0 ? plot_grid_draw(page, plot, &below, err)
                                : one_frame(page, plot, &axes, is_below, err)))
        return false;
    if (is_below) legend_below_draw(page, &plot->main, &below);
    return true;
}

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

// Legend and ends of the colours as the style asks.
static bool take_style(Plot *plot, const PictureStyle *style, Error *err)
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

bool figure_plot(Page *page, Plot *plot, const PictureStyle *style, const char *title, Error *err)
{
    PictureStyle used = *style;
    double width = 0;
    picture_style_complete(&used, &plot->style);
    PageDef def = {.style = &used, .title = page_title(&used, title, true)};
    def.height = page_shape(&used, plot->height_over_width);
    if (plot->panel_count > 0) plot_grid_size(plot, &def.height, &width);
    if (!(used.width > 0) && !used.style) used.width = width;
    if (!take_style(plot, &used, err)) return false;
    if (used.compare && !plot_compare(plot, used.compare, err)) return false;
    return page_begin(page, &def, err) && figure_curves(page, plot, err);
}

// The module's second entry: one plot from its description to its file.
__attribute__((visibility("default"))) bool
amontons_render_plot(const char *path, const char *picture, const PictureStyle *style, Error *err)
{
    PictureStyle used = style ? *style : (PictureStyle){0};
    Page page = {0};
    Plot *plot = NEW_ARRAY(Plot, 1, err);
    TRY(plot);
    TRY(page_style_of_name(picture, &used, err));
    static const char *const name[] = {"plot"};
    TRY(picture_options_fit(&used, NULL, name, 1, err));
    TRY(plot_file_read(path, plot, err));
    if (!picture_options_fit(&plot->style, NULL, name, 1, err))
        error_context(err, "%s: page", path);
    TRY(error_is_clean(err));
    TRY(figure_plot(&page, plot, &used, plot->title, err));
    TRY(page_finish(&page, picture, plot->title, err));
    TRY(plot_compare_write(plot, picture, err));
cleanup:
    page_destroy(&page);
    if (plot) plot_destroy(plot);
    memory_free(plot);
    return error_is_clean(err);
}
