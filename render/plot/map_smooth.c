// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/plot/map_smooth.h"

#include "base/memory.h"

#include <math.h>

// Slope at a point from the slopes before and behind it, over distances h: 0 at a summit, never so
// steep that the cubic leaves the values; where there is but one of them, that one.
static double limited_slope(double before, double behind, double h_before, double h_behind)
{
    if (!isfinite(before)) return isfinite(behind) ? behind : 0;
    if (!isfinite(behind)) return before;
    if (!(before * behind > 0)) return 0;
    double w1 = 2 * h_behind + h_before, w2 = h_behind + 2 * h_before;
    return (w1 + w2) / (w1 / before + w2 / behind);
}

static double slope_between(const double *x, const double *y, int32_t k, int32_t count)
{
    return k < 0 || k + 1 >= count ? NAN : (y[k + 1] - y[k]) / (x[k + 1] - x[k]);
}

static double slope_at(const double *x, const double *y, int32_t k, int32_t count)
{
    double h_before = k > 0 ? x[k] - x[k - 1] : 0, h_behind = k + 1 < count ? x[k + 1] - x[k] : 0;
    return limited_slope(slope_between(x, y, k - 1, count), slope_between(x, y, k, count), h_before,
                         h_behind);
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

typedef struct Work {
    double *x, *y;   // [columns], [rows] of the grid; owned, as all
    double *fine_x, *fine_y;   // of the finer one
    double *half;   // [rows * fine columns]
    double *from, *to;   // a column before and after
} Work;

static void work_destroy(Work *work)
{
    memory_free(work->x);
    memory_free(work->y);
    memory_free(work->fine_x);
    memory_free(work->fine_y);
    memory_free(work->half);
    memory_free(work->from);
    memory_free(work->to);
}

static bool work_create(const MapGrid *grid, const SmoothGrid *smooth, Work *work, Error *err)
{
    if (!(work->x = NEW_ARRAY(double, grid->columns, err))) return false;
    if (!(work->y = NEW_ARRAY(double, grid->rows, err))) return false;
    if (!(work->fine_x = NEW_ARRAY(double, smooth->columns, err))) return false;
    if (!(work->fine_y = NEW_ARRAY(double, smooth->rows, err))) return false;
    if (!(work->half = NEW_ARRAY(double, (int64_t)grid->rows * smooth->columns, err))) return false;
    if (!(work->from = NEW_ARRAY(double, grid->columns + grid->rows, err))) return false;
    if (!(work->to = NEW_ARRAY(double, smooth->rows, err))) return false;
    return true;
}

// First along each row, then along each finer column.
static void smooth_both(const MapGrid *grid, const double *values, int32_t parts, Work *work,
                        SmoothGrid *smooth)
{
    for (int32_t row = 0; row < grid->rows; ++row) {
        for (int32_t k = 0; k < grid->columns; ++k) {
            int32_t point = grid->point[row * grid->columns + k];
            work->from[k] = point < 0 ? NAN : values[point];
        }
        line_smooth(work->x, work->from, grid->columns, parts,
                    work->half + (int64_t)row * smooth->columns);
    }
    for (int32_t column = 0; column < smooth->columns; ++column) {
        for (int32_t row = 0; row < grid->rows; ++row)
            work->from[row] = work->half[(int64_t)row * smooth->columns + column];
        line_smooth(work->y, work->from, grid->rows, parts, work->to);
        for (int32_t row = 0; row < smooth->rows; ++row)
            smooth->value[(int64_t)row * smooth->columns + column] = work->to[row];
    }
}

static bool find_triangles(SmoothGrid *smooth, Error *err)
{
    int64_t cells = (int64_t)(smooth->columns - 1) * (smooth->rows - 1);
    if (!(smooth->triangles = NEW_ARRAY(int32_t, 6 * cells, err))) return false;
    int32_t *corner = smooth->triangles;
    for (int32_t row = 0; row + 1 < smooth->rows; ++row)
        for (int32_t column = 0; column + 1 < smooth->columns; ++column) {
            int32_t first = row * smooth->columns + column, above = first + smooth->columns;
            const int32_t both[6] = {first, first + 1, above + 1, first, above + 1, above};
            for (int32_t i = 0; i < 6; ++i) *corner++ = both[i];
        }
    smooth->triangle_count = 2 * cells;
    return true;
}

bool map_smooth(const MapGrid *grid, const double *values, const Point *place, int32_t parts,
                SmoothGrid *smooth, Error *err)
{
    Work work = {0};
    *smooth = (SmoothGrid){.columns = (grid->columns - 1) * parts + 1,
                           .rows = (grid->rows - 1) * parts + 1};
    int64_t count = (int64_t)smooth->columns * smooth->rows;
    TRY(smooth->place = NEW_ARRAY(Point, count, err));
    TRY(smooth->value = NEW_ARRAY(double, count, err));
    TRY(work_create(grid, smooth, &work, err));
    find_lines(grid, place, true, work.x);
    find_lines(grid, place, false, work.y);
    for (int32_t k = 0; k < smooth->columns; ++k) {
        int32_t at = k / parts, next = at + 1 < grid->columns ? at + 1 : at;
        work.fine_x[k] = work.x[at] + (double)(k % parts) / parts * (work.x[next] - work.x[at]);
    }
    for (int32_t k = 0; k < smooth->rows; ++k) {
        int32_t at = k / parts, next = at + 1 < grid->rows ? at + 1 : at;
        work.fine_y[k] = work.y[at] + (double)(k % parts) / parts * (work.y[next] - work.y[at]);
    }
    for (int64_t k = 0; k < count; ++k)
        smooth->place[k] =
            (Point){work.fine_x[k % smooth->columns], -work.fine_y[k / smooth->columns]};
    TRY(find_triangles(smooth, err));
    smooth_both(grid, values, parts, &work, smooth);
cleanup:
    work_destroy(&work);
    if (!error_is_clean(err)) smooth_destroy(smooth);
    return error_is_clean(err);
}

void smooth_destroy(SmoothGrid *smooth)
{
    memory_free(smooth->place);
    memory_free(smooth->value);
    memory_free(smooth->triangles);
    *smooth = (SmoothGrid){0};
}
