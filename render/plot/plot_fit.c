// SPDX-License-Identifier: GPL-2.0-or-later
// All in the scale of the axis: logarithms on a logarithmic one.
#include "render/plot/plot_fit.h"

#include "render/plot/map_cells.h"

#include <math.h>

static const double MARGIN = 0.05;   // of the data's range, beside the data

typedef struct Ends {
    double low, high;   // of marks and lines: a margin goes beside them
    double edge_low, edge_high;   // of cells: none
} Ends;

// NaN and what the axis cannot show are left out.
static void widen(const Axis *axis, const double *values, int32_t count, Ends *ends)
{
    for (int32_t k = 0; values && k < count; k++) {
        if (!isfinite(values[k]) || (axis->is_log && values[k] <= 0)) continue;
        double value = axis->is_log ? log10(values[k]) : values[k];
        ends->low = fmin(ends->low, value);
        ends->high = fmax(ends->high, value);
    }
}

// axes: x and y, of which one is looked for.
static bool widen_by_map(const Axis axes[2], int32_t which, const PlotMap *map, Ends *ends,
                         Error *err)
{
    MapGrid grid = {0};
    TRY(map_grid_find(map, axes[0].is_log, axes[1].is_log, &grid, err));
    if (grid.columns > 0) {
        ends->edge_low = fmin(ends->edge_low, which ? grid.y[0] : grid.x[0]);
        ends->edge_high = fmax(ends->edge_high, which ? grid.y[grid.rows] : grid.x[grid.columns]);
    } else {
        widen(&axes[which], which ? map->y : map->x, map->count, ends);
    }
cleanup:
    map_grid_destroy(&grid);
    return error_is_clean(err);
}

static bool widen_by_panel(const PlotPanel *panel, const Axis axes[2], int32_t which, Ends *ends,
                           Error *err)
{
    bool has_bars = which == (axes[1].names ? 0 : 1);
    for (int32_t k = 0; k < panel->series_count; k++) {
        const PlotSeries *series = &panel->series[k];
        widen(&axes[which], which ? series->y : series->x, series->count, ends);
        if (has_bars) widen(&axes[which], series->low, series->count, ends);
        if (has_bars) widen(&axes[which], series->high, series->count, ends);
    }
    return !panel->has_map || widen_by_map(axes, which, &panel->map, ends, err);
}

static void set_ends(Axis *axis, const Ends *ends)
{
    double low = ends->low, high = ends->high;
    bool has_edges = ends->edge_high > ends->edge_low;
    if (!(high >= low) && !has_edges) low = high = 0;
    if (high >= low) {
        double margin = MARGIN * (high - low);
        if (!(margin > 0)) margin = fmax(0.1, 0.1 * fabs(low));
        low -= margin;
        high += margin;
    }
    low = fmin(low, ends->edge_low);
    high = fmax(high, ends->edge_high);
    axis->low = axis->is_log ? pow(10, low) : low;
    axis->high = axis->is_log ? pow(10, high) : high;
}

// panels: those that share the axes of `panel`, [count]; none for an inset.
static bool fit(PlotPanel *panel, const PlotPanel *panels, int32_t count, Error *err)
{
    Axis axes[2] = {panel->x, panel->y}, *axis[2] = {&panel->x, &panel->y};
    for (int32_t which = 0; which < 2; which++) {
        Ends ends = {INFINITY, -INFINITY, INFINITY, -INFINITY};
        if (isfinite(axis[which]->low)) continue;
        if (axis[which]->names) {
            axis[which]->low = 0.5;
            axis[which]->high = axis[which]->name_count + 0.5;
            continue;
        }
        if (!widen_by_panel(panel, axes, which, &ends, err)) return false;
        for (int32_t k = 0; k < count; k++)
            if (!widen_by_panel(&panels[k], axes, which, &ends, err)) return false;
        set_ends(axis[which], &ends);
    }
    return true;
}

// Least and largest of a quantity of all maps: their values, or what their lines show.
static void find_values(const Plot *plot, bool of_contours, double found[2])
{
    const Axis plain = {0};
    Ends ends = {INFINITY, -INFINITY, 0, 0};
    for (int32_t k = -1; k < plot->panel_count; k++) {
        const PlotMap *map = k < 0 ? &plot->main.map : &plot->panels[k].map;
        widen(&plain, of_contours ? map->contour : map->value, map->count, &ends);
    }
    found[0] = ends.low <= ends.high ? ends.low : 0;
    found[1] = ends.low <= ends.high ? ends.high : 0;
}

static void set_found(Axis *axis, const double found[2])
{
    if (isfinite(axis->low)) return;
    axis->low = found[0];
    axis->high = found[1];
}

bool plot_fit_axes(Plot *plot, Error *err)
{
    double levels[2];
    find_values(plot, false, plot->found);
    find_values(plot, true, levels);
    set_found(&plot->color, plot->found);
    set_found(&plot->contours, levels);
    return fit(&plot->main, plot->panels, plot->panel_count, err) &&
           (!plot->has_inset || fit(&plot->inset, NULL, 0, err));
}
