// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/plot/map_cells.h"

#include "base/memory.h"
#include "base/order.h"

#include <math.h>
#include <stdlib.h>

static const double SAME = 1e-9;   // of the range: values nearer than this are one
static const double TAKEN_LEAST = 0.5;   // of a grid's places
static const double LONE_WIDTH = 0.3;   // of a cell that has no neighbour, decades or lengths

static double scaled(double value, bool is_log)
{
    if (!is_log) return value;
    return value > 0 ? log10(value) : NAN;
}

// The different ones of [count] values, rising, into *lines. Returns how many; -1: no memory.
static int32_t find_lines(const double *values, int32_t count, bool is_log, double **lines,
                          Error *err)
{
    int32_t kept = 0, found = 0;
    double *sorted = NEW_ARRAY(double, count + 1, err);
    *lines = sorted;
    if (!sorted) return -1;
    for (int32_t k = 0; k < count; k++) {
        double value = scaled(values[k], is_log);
        if (isfinite(value)) sorted[kept++] = value;
    }
    qsort(sorted, (size_t)kept, sizeof *sorted, order_doubles);
    double least = kept > 0 ? SAME * (sorted[kept - 1] - sorted[0]) : 0;
    for (int32_t k = 0; k < kept; k++)
        if (found == 0 || sorted[k] - sorted[found - 1] > least) sorted[found++] = sorted[k];
    return found;
}

// Finds among [count] rising lines the one nearest to `value`.
static int32_t nearest_line(const double *lines, int32_t count, double value)
{
    int32_t low = 0, high = count - 1;
    while (high > low) {
        int32_t middle = (low + high) / 2;
        if (value - lines[middle] > lines[middle + 1] - value)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

bool map_grid_find(const PlotMap *map, bool x_is_log, bool y_is_log, MapGrid *grid, Error *err)
{
    *grid = (MapGrid){0};
    int32_t columns = find_lines(map->x, map->count, x_is_log, &grid->x, err);
    if (columns < 0) return false;
    int32_t rows = find_lines(map->y, map->count, y_is_log, &grid->y, err);
    if (rows < 0) return false;
    grid->columns = columns;
    grid->rows = rows;

    // Each point has a cell to itself, and most cells a point.
    int64_t places = (int64_t)columns * rows;
    bool is_grid = columns > 0 && map->count >= TAKEN_LEAST * columns * rows;
    if (is_grid && !(grid->point = NEW_ARRAY(int32_t, places, err))) return false;
    for (int64_t k = 0; is_grid && k < places; k++) grid->point[k] = -1;
    for (int32_t k = 0; is_grid && k < map->count; k++) {
        double x = scaled(map->x[k], x_is_log), y = scaled(map->y[k], y_is_log);
        if (!isfinite(x) || !isfinite(y)) continue;
        int32_t *cell = &grid->point[(int64_t)nearest_line(grid->y, rows, y) * columns +
                                     nearest_line(grid->x, columns, x)];
        is_grid = *cell < 0;
        *cell = k;
    }
    if (!is_grid) {
        map_grid_destroy(grid);
        return true;
    }

    // Turn [count] lines into [count + 1] edges in the same array.
    for (int32_t d = 0; d < 2; d++) {
        double *lines = d ? grid->y : grid->x, half = LONE_WIDTH / 2;
        int32_t count = d ? rows : columns;
        if (count == 1) {
            lines[1] = lines[0] + half;
            lines[0] -= half;
            continue;
        }
        double first = lines[0] - (lines[1] - lines[0]) / 2;
        double last = lines[count - 1] + (lines[count - 1] - lines[count - 2]) / 2;
        for (int32_t k = count - 1; k > 0; k--) lines[k] = (lines[k - 1] + lines[k]) / 2;
        lines[0] = first;
        lines[count] = last;
    }
    return true;
}

void map_grid_destroy(MapGrid *grid)
{
    memory_free_all(grid->x, grid->y, grid->point);
    *grid = (MapGrid){0};
}

void map_medians(const MapGrid *grid, const double *values, double *medians)
{
    double near[MAP_MEDIANS * MAP_MEDIANS];
    for (int32_t k = 0; k < grid->rows * grid->columns; ++k) {
        int32_t count = 0;
        if (grid->point[k] < 0) continue;
        for (int32_t n = 0; n < MAP_MEDIANS * MAP_MEDIANS; ++n) {
            int32_t row = k / grid->columns + n / MAP_MEDIANS - MAP_MEDIANS / 2;
            int32_t column = k % grid->columns + n % MAP_MEDIANS - MAP_MEDIANS / 2;
            bool outside = row < 0 || row >= grid->rows || column < 0 || column >= grid->columns;
            int32_t point = outside ? -1 : grid->point[row * grid->columns + column];
            if (point >= 0 && isfinite(values[point])) near[count++] = values[point];
        }
        qsort(near, (size_t)count, sizeof *near, order_doubles);
        bool known = isfinite(values[grid->point[k]]);
        medians[grid->point[k]] = known ? near[count / 2] : NAN;
    }
}
