// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/plot/map_smooth.h"

#include "base/memory.h"
#include "base/order.h"

#include <math.h>
#include <stdlib.h>

static double slope_between(const double *x, const double *y, int32_t k, int32_t count)
{
    return k < 0 || k + 1 >= count ? NAN : (y[k + 1] - y[k]) / (x[k + 1] - x[k]);
}

static double slope_at(const double *x, const double *y, int32_t k, int32_t count)
{
    double h_before = k > 0 ? x[k] - x[k - 1] : 0, h_behind = k + 1 < count ? x[k + 1] - x[k] : 0;

    // Slope at a point from the slopes before and behind it, over distances h: 0 at a summit, never
    // so steep that the cubic leaves the values; where there is but one of them, that one.
    double before = slope_between(x, y, k - 1, count);
    double behind = slope_between(x, y, k, count);
    if (!isfinite(before)) return isfinite(behind) ? behind : 0;
    if (!isfinite(behind)) return before;
    if (!(before * behind > 0)) return 0;
    double w1 = 2 * h_behind + h_before, w2 = h_behind + 2 * h_before;
    return (w1 + w2) / (w1 / before + w2 / behind);
}

// fine: [(count - 1) * parts + 1] values of the cubics through (x, y), [count].
static void line_smooth(const double *x, const double *y, int32_t count, int32_t parts,
                        double *fine)
{
    for (int32_t k = 0; k + 1 < count; ++k) {
        double h = x[k + 1] - x[k], slopes[2];
        for (int32_t end = 0; end < 2; ++end) slopes[end] = h * slope_at(x, y, k + end, count);
        fine[k * parts] = y[k];   // also before a hole
        for (int32_t part = 1; part < parts; ++part) {
            double s = (double)part / parts, rise = y[k + 1] - y[k];
            fine[k * parts + part] = y[k] + s * s * (3 - 2 * s) * rise +
                                     s * (1 - s) * ((1 - s) * slopes[0] - s * slopes[1]);
        }
    }
    fine[(count - 1) * parts] = y[count - 1];
}

// Places of the grid's columns or rows, from any point in each: [count]; rising.
static void find_lines(const MapGrid *grid, const Point *place, bool of_columns, double *lines)
{
    for (int64_t k = 0; k < (int64_t)grid->rows * grid->columns; ++k) {
        if (grid->point[k] < 0) continue;
        Point at = place[grid->point[k]];
        lines[of_columns ? k % grid->columns : k / grid->columns] = of_columns ? at.x : -at.y;
    }
}

// Place of the k-th finer line, with [count] lines and `parts` between any two.
static double fine_line(const double *lines, int32_t count, int32_t parts, int32_t k)
{
    int32_t at = k / parts, next = at + 1 < count ? at + 1 : at;
    return lines[at] + (double)(k % parts) / parts * (lines[next] - lines[at]);
}

bool map_smooth(const MapGrid *grid, const double *values, const Point *place, int32_t parts,
                SmoothGrid *smooth, Error *err)
{
    double *work = NULL;
    int32_t columns = (grid->columns - 1) * parts + 1, rows = (grid->rows - 1) * parts + 1;
    MapGrid cells = {.columns = columns, .rows = rows};   // each finer point in one of its own
    int64_t count = (int64_t)columns * rows, lines = grid->columns + grid->rows;
    *smooth = (SmoothGrid){.columns = columns, .rows = rows};
    TRY(smooth->place = NEW_ARRAY(Point, count, err));
    TRY(smooth->value = NEW_ARRAY(double, count, err));
    TRY(work = NEW_ARRAY(double, 2 * lines + (int64_t)grid->rows * columns + rows, err));
    double *x = work, *y = x + grid->columns;   // lines of the grid
    double *half = y + grid->rows;   // [grid->rows * columns] finer along x alone
    double *from = half + (int64_t)grid->rows * columns;   // [columns, or rows, of the grid]
    double *to = from + lines;   // [rows]
    find_lines(grid, place, true, x);
    find_lines(grid, place, false, y);

    // First along each row, then along each finer column.
    for (int32_t row = 0; row < grid->rows; ++row) {
        for (int32_t k = 0; k < grid->columns; ++k) {
            int32_t point = grid->point[row * grid->columns + k];
            from[k] = point < 0 ? NAN : values[point];
        }
        line_smooth(x, from, grid->columns, parts, half + (int64_t)row * columns);
    }
    for (int32_t column = 0; column < columns; ++column) {
        for (int32_t row = 0; row < grid->rows; ++row)
            from[row] = half[(int64_t)row * columns + column];
        line_smooth(y, from, grid->rows, parts, to);
        for (int32_t row = 0; row < rows; ++row) {
            int64_t k = (int64_t)row * columns + column;
            smooth->value[k] = to[row];
            smooth->place[k] = (Point){fine_line(x, grid->columns, parts, column),
                                       -fine_line(y, grid->rows, parts, row)};
        }
    }

    TRY(cells.point = NEW_ARRAY(int32_t, count, err));
    for (int32_t k = 0; k < count; ++k) cells.point[k] = k;
    TRY(map_triangles_find(&cells, &smooth->triangles, err));
cleanup:
    memory_free_all(work, cells.point);
    if (!error_is_clean(err)) smooth_destroy(smooth);
    return error_is_clean(err);
}

void smooth_destroy(SmoothGrid *smooth)
{
    memory_free_all(smooth->place, smooth->value, smooth->triangles.points);
    *smooth = (SmoothGrid){0};
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
