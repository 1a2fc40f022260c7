// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/plot/map_cells.h"

#include "base/memory.h"
#include "base/order.h"
#include "render/plot/triangulate.h"

#include <math.h>
#include <stdlib.h>

static const double SAME = 1e-9;   // of the range: values nearer than this are one
static const double TAKEN_LEAST = 0.5;   // of a grid's places
static const double LONE_WIDTH = 0.3;   // of a cell that has no neighbour, decades or lengths
static const double SIDE_MAX = 3;   // times the usual distance there: a longer side spans a gap

static double scaled(double value, bool is_log)
{
    if (!is_log) return value;
    return value > 0 ? log10(value) : NAN;
}

// --- grid ---------------------------------------------------------------------------------------

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

// From [count] lines to [count + 1] edges in the same array.
static void lines_to_edges(double *lines, int32_t count)
{
    if (count == 1) {
        double half = LONE_WIDTH / 2;
        lines[1] = lines[0] + half;
        lines[0] -= half;
        return;
    }
    double first = lines[0] - (lines[1] - lines[0]) / 2;
    double last = lines[count - 1] + (lines[count - 1] - lines[count - 2]) / 2;
    for (int32_t k = count - 1; k > 0; k--) lines[k] = (lines[k - 1] + lines[k]) / 2;
    lines[0] = first;
    lines[count] = last;
}

// false: two points at one place, or no memory.
static bool fill_cells(const PlotMap *map, const bool is_log[2], MapGrid *grid, Error *err)
{
    int64_t places = (int64_t)grid->columns * grid->rows;
    if (!(grid->point = NEW_ARRAY(int32_t, places, err))) return false;
    for (int64_t k = 0; k < places; k++) grid->point[k] = -1;
    for (int32_t k = 0; k < map->count; k++) {
        double x = scaled(map->x[k], is_log[0]), y = scaled(map->y[k], is_log[1]);
        if (!isfinite(x) || !isfinite(y)) continue;
        int32_t *cell = &grid->point[(int64_t)nearest_line(grid->y, grid->rows, y) * grid->columns +
                                     nearest_line(grid->x, grid->columns, x)];
        if (*cell >= 0) return false;
        *cell = k;
    }
    return true;
}

bool map_grid_find(const PlotMap *map, bool x_is_log, bool y_is_log, MapGrid *grid, Error *err)
{
    const bool is_log[2] = {x_is_log, y_is_log};
    *grid = (MapGrid){0};
    int32_t columns = find_lines(map->x, map->count, x_is_log, &grid->x, err);
    if (!(columns >= 0)) return false;
    int32_t rows = find_lines(map->y, map->count, y_is_log, &grid->y, err);
    if (!(rows >= 0)) return false;
    grid->columns = columns;
    grid->rows = rows;
    bool full = columns > 0 && map->count >= TAKEN_LEAST * columns * rows &&
                fill_cells(map, is_log, grid, err);
    if (!error_is_clean(err)) return false;
    if (full) {
        lines_to_edges(grid->x, columns);
        lines_to_edges(grid->y, rows);
    } else {
        map_grid_destroy(grid);
    }
    return true;
}

void map_grid_destroy(MapGrid *grid)
{
    memory_free_all(grid->x, grid->y, grid->point);
    *grid = (MapGrid){0};
}

// --- triangles ----------------------------------------------------------------------------------

// Two in the middle of any four cells that meet and hold points.
static bool grid_triangles(const MapGrid *grid, MapTriangles *triangles, Error *err)
{
    triangles->points = NEW_ARRAY(int32_t, 6 * (int64_t)grid->columns * grid->rows, err);
    if (!triangles->points) return false;
    for (int32_t row = 0; row + 1 < grid->rows; row++)
        for (int32_t column = 0; column + 1 < grid->columns; column++) {
            const int32_t *low = &grid->point[(int64_t)row * grid->columns + column];
            const int32_t *high = low + grid->columns;
            if (low[0] < 0 || low[1] < 0 || high[0] < 0 || high[1] < 0) continue;
            const int32_t pair[6] = {low[0], low[1], high[1], low[0], high[1], high[0]};
            for (int32_t k = 0; k < 6; k++)
                triangles->points[6 * (triangles->count / 2) + k] = pair[k];
            triangles->count += 2;
        }
    return true;
}

static double longest_side(const Point *place, const int32_t corner[3])
{
    double longest = 0;
    for (int32_t k = 0; k < 3; k++) {
        Point a = place[corner[k]], b = place[corner[(k + 1) % 3]];
        longest = fmax(longest, hypot(b.x - a.x, b.y - a.y));
    }
    return longest;
}

// Into near[point]: the geometric mean of its triangles' sides; a few long ones change it little.
static bool find_near(const Point *place, int32_t count, const MapTriangles *triangles,
                      double *near, Error *err)
{
    int32_t *sides = NEW_ARRAY(int32_t, count, err);
    if (!sides) return false;
    for (int32_t k = 0; k < 3 * triangles->count; k++) {
        int32_t a = triangles->points[k], b = triangles->points[k % 3 == 2 ? k - 2 : k + 1];
        double length = log(hypot(place[b].x - place[a].x, place[b].y - place[a].y));
        near[a] += length;
        near[b] += length;
        sides[a]++;
        sides[b]++;
    }
    for (int32_t k = 0; k < count; k++) near[k] = exp(near[k] / sides[k]);
    memory_free(sides);
    return true;
}

// Leaves out triangles that span a gap.
static bool drop_long(const Point *place, int32_t count, MapTriangles *triangles, Error *err)
{
    int32_t kept = 0;
    double *near = NEW_ARRAY(double, (int64_t)count + 1, err);
    TRY(near);
    TRY(find_near(place, count, triangles, near, err));
    for (int32_t k = 0; k < triangles->count; k++) {
        const int32_t *corner = triangles->points + 3 * k;
        double usual = fmax(near[corner[0]], fmax(near[corner[1]], near[corner[2]]));
        if (longest_side(place, corner) > SIDE_MAX * usual) continue;
        for (int32_t i = 0; i < 3; i++) triangles->points[3 * kept + i] = corner[i];
        kept++;
    }
    triangles->count = kept;
cleanup:
    memory_free(near);
    return error_is_clean(err);
}

bool map_triangles_find(const MapGrid *grid, const Point *place, int32_t count,
                        MapTriangles *triangles, Error *err)
{
    *triangles = (MapTriangles){0};
    if (grid->columns > 0) return grid_triangles(grid, triangles, err);
    return triangulate(place, count, &triangles->points, &triangles->count, err) &&
           drop_long(place, count, triangles, err);
}

void map_triangles_destroy(MapTriangles *triangles)
{
    memory_free(triangles->points);
    *triangles = (MapTriangles){0};
}
