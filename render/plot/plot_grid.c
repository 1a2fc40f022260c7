// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/plot/plot_grid.h"

#include "render/plot/panel.h"

#include <math.h>

static const double BETWEEN = 7;   // points between frames side by side
static const double TITLE_HEIGHT = 13.5, TITLE_DROP = 3;   // points: above each frame; its baseline
static const double RIGHT_MARGIN = 9, BAR_GAP = 6;   // points: beside the last frame; to the bar
static const double WIDTH_OF[] = {86, 130, 178, 178};   // mm, of so many columns: a journal's sizes
static const double BESIDE = 0.24,
                    ABOVE = 0.16;   // of the page's width: axis and bar; names, legend

typedef struct GridPage {
    const Plot *plot;
    MapScale scale;
    int32_t columns, rows;
    bool has_bar;
    double left, top, width, height;   // of the first frame, pixels
} GridPage;

static int32_t column_count(int32_t panels)
{
    if (panels <= 3) return panels;
    if (panels == 4) return 2;
    return panels <= 9 ? 3 : 4;
}

static bool has_map(const Plot *plot)
{
    bool found = plot->main.has_map;
    for (int32_t k = 0; k < plot->panel_count; k++) found = found || plot->panels[k].has_map;
    return found;
}

void plot_grid_size(const Plot *plot, double *height, double *width)
{
    int32_t columns = column_count(plot->panel_count);
    int32_t rows = (plot->panel_count + columns - 1) / columns;
    *width = WIDTH_OF[columns - 1];
    *height = rows * plot->height_over_width * (1 - BESIDE) / columns + ABOVE;
}

static GridPage lay_out(const Page *page, const Plot *plot, const Box *below, const Axes *axes)
{
    double point = page->point, right = RIGHT_MARGIN;
    GridPage grid = {.plot = plot, .scale = map_scale_fit(plot), .has_bar = has_map(plot)};
    grid.columns = column_count(plot->panel_count);
    grid.rows = (plot->panel_count + grid.columns - 1) / grid.columns;
    if (grid.has_bar) right = BAR_GAP + colorbar_width(page, &grid.scale.bar);
    grid.left = round(axes_left_margin(page, axes) * point);
    grid.top = page->room.top + TITLE_HEIGHT * point;
    double wide = canvas_width(page->canvas) - right * point - grid.left;
    double high = below->top - axes_bottom_margin(axes) * point - page->room.top;
    grid.width = floor((wide - (grid.columns - 1) * BETWEEN * point) / grid.columns);
    grid.height = floor(high / grid.rows - TITLE_HEIGHT * point);
    return grid;
}

static Box frame_of(const Page *page, const GridPage *grid, int32_t k)
{
    double across = grid->width + BETWEEN * page->point;
    double down = grid->height + TITLE_HEIGHT * page->point;
    int32_t line = k / grid->columns;
    Box box = {.left = round(grid->left + across * (k % grid->columns)),
               .top = round(grid->top + down * line)};
    box.right = box.left + grid->width;
    box.bottom = box.top + grid->height;
    return box;
}

static bool draw_one(const Page *page, const GridPage *grid, int32_t k, Error *err)
{
    const Plot *plot = grid->plot;
    const PlotPanel *panel = &plot->panels[k];
    TextStyle style = {.size = NUMBER_SIZE * page->point, .color = INK, .across = 0.5};
    PanelDef def = {.panel = panel, .common = &plot->main, .scale = &grid->scale, .share = 0.8};
    Axes axes = {.box = frame_of(page, grid, k),
                 .x = plot->main.x,
                 .y = plot->main.y,
                 .bare_x = k + grid->columns<plot->panel_count, .bare_y = k % grid->columns> 0};
    Point above = {(axes.box.left + axes.box.right) / 2, axes.box.top - TITLE_DROP * page->point};
    if (!panel_draw(page, &def, &axes, err)) return false;
    text_draw(page->text, &style, above, panel->title);
    return true;
}

bool plot_grid_draw(const Page *page, const Plot *plot, const Box *below, Error *err)
{
    Axes axes = {.x = plot->main.x, .y = plot->main.y};
    axes.box.bottom = (below->top - page->room.top) / 2;   // where ticks are counted
    GridPage grid = lay_out(page, plot, below, &axes);
    if (grid.width < 2 * BETWEEN * page->point || grid.height < 2 * BETWEEN * page->point)
        return REFUSE(err, "the page is too small for %d panels", plot->panel_count);
    for (int32_t k = 0; k < plot->panel_count; k++)
        if (!draw_one(page, &grid, k, err)) return false;
    if (grid.has_bar) {
        Box last = frame_of(page, &grid, grid.columns - 1), all = last;
        all.bottom = frame_of(page, &grid, (grid.rows - 1) * grid.columns).bottom;
        colorbar_draw(page, &grid.scale.bar, &all, BAR_GAP);
    }
    return true;
}
