// SPDX-License-Identifier: GPL-2.0-or-later
// From values at (step, node) to pixels in two moves: steps to columns, then nodes to rows. A pixel
// shows the largest value that falls into it, because what matters in these maps is short and
// narrow: a mean would hide it. Steps are far from equal: some columns hold hundreds of them,
// others lie inside one.
#include "render/view/space_time.h"

#include "base/memory.h"

#include <math.h>

static const double ROUND_DOWN = 0.5;   // columns: an event not longer than its mark by more is one

// Half way to the neighbours on the same pad; the last node of a pad has nothing beyond it, so that
// gaps stay gaps.
void node_extent(const SpaceTime *data, int32_t i, double *from, double *to)
{
    bool joined_before = i > 0 && data->pad[i - 1] == data->pad[i];
    bool joined_after = i + 1 < data->nodes && data->pad[i + 1] == data->pad[i];
    *from = joined_before ? (data->x[i - 1] + data->x[i]) / 2 : data->x[i];
    *to = joined_after ? (data->x[i] + data->x[i + 1]) / 2 : data->x[i];
}

// The larger of two, where NaN means none.
static float larger(float a, float b)
{
    return isnan(b) || a >= b ? a : b;
}

// Column of a step, -1 before the first, `columns` behind the last.
static int32_t column_of(const PixelGrid *grid, double U)
{
    double place = (U - grid->U_low) / (grid->U_high - grid->U_low) * grid->columns;
    if (place < 0) return -1;
    if (U == grid->U_high) return grid->columns - 1;
    return place >= grid->columns ? grid->columns : (int32_t)place;
}

// The first column of a step, and in *count how many: of a short rapid event always the same.
static int32_t columns_of_step(const SpaceTime *data, const PixelGrid *grid, double U,
                               int32_t *count)
{
    double width = (grid->U_high - grid->U_low) / grid->columns;
    int32_t column = column_of(grid, U);
    *count = 1;
    if (column < 0 || column == grid->columns) return column;   // of most steps of a long run
    for (int32_t k = 0; k < data->event_count; ++k) {
        const double *event = data->events[k];
        double room = (grid->event_columns + ROUND_DOWN) * width;
        if (!(U >= event[0] && U <= event[1]) || event[1] - event[0] >= room) continue;
        int32_t middle = column_of(grid, (event[0] + event[1]) / 2);
        if (middle < 0 || middle == grid->columns) return middle;
        *count = grid->event_columns;
        return middle - *count / 2 < 0 ? 0 : middle - *count / 2;
    }
    return column;
}

// by_column: [columns * nodes], times the sign.
static void step_add(const SpaceTime *data, int64_t row, int32_t column, float *by_column)
{
    const double *value = data->value + row * data->nodes;
    float *cell = by_column + (int64_t)column * data->nodes;
    for (int32_t i = 0; i < data->nodes; ++i) {
        double counts = data->sign ? data->sign * value[i] : fabs(value[i]);
        cell[i] = larger(cell[i], (float)counts);
    }
}

// The largest value at each column and node, [columns * nodes]; `next[column]`: -1 where steps lie
// inside, else the step that ends behind it (data->rows: none).
static void columns_gather(const SpaceTime *data, const PixelGrid *grid, float *by_column,
                           int64_t *next)
{
    int32_t reached = 0;   // columns before this one are settled, but for the steps inside
    for (int32_t column = 0; column < grid->columns; ++column) next[column] = data->rows;
    for (int64_t k = 0; k < (int64_t)data->nodes * grid->columns; ++k) by_column[k] = NAN;
    for (int64_t row = 0; row < data->rows; ++row) {
        if (!isfinite(data->U[row])) continue;
        int32_t wide = 1, column = columns_of_step(data, grid, data->U[row], &wide);
        if (column < 0) continue;
        for (; reached < column; ++reached)
            if (next[reached] == data->rows) next[reached] = row;
        if (column == grid->columns) break;
        for (int32_t k = column; k < column + wide && k < grid->columns; ++k) {
            next[k] = -1;
            step_add(data, row, k, by_column);
        }
    }
}

// Slip of node i when the rod was at U, from row *at on, which is led along.
static double slip_at(const SpaceTime *data, int32_t i, double U, int64_t *at)
{
    while (*at + 2 < data->rows && data->U[*at + 1] < U) ++*at;
    double low = data->U[*at], high = data->U[*at + 1];
    double part = high > low ? fmin(fmax((U - low) / (high - low), 0), 1) : 0;
    const double *slip = data->slip + *at * data->nodes + i;
    return slip[0] + part * (slip[data->nodes] - slip[0]);
}

// Values that are not finite stay unknown.
static void columns_mean(const SpaceTime *data, const PixelGrid *grid, float *by_column)
{
    double width = (grid->U_high - grid->U_low) / grid->columns;
    for (int32_t i = 0; i < data->nodes; ++i) {
        int64_t at = 0;
        double before = slip_at(data, i, grid->U_low, &at);
        for (int32_t column = 0; column < grid->columns; ++column) {
            double slip = slip_at(data, i, grid->U_low + (column + 1) * width, &at);
            by_column[(int64_t)column * data->nodes + i] =
                (float)(fabs(slip - before) / width * data->V);
            before = slip;
        }
    }
}

// grid->values is made here; pixel_grid_destroy.
bool space_time_to_pixels(const SpaceTime *data, PixelGrid *grid, Error *err)
{
    float *by_column = NULL;
    int64_t *next = NULL;
    TRY(by_column = NEW_ARRAY(float, (int64_t)data->nodes * grid->columns, err));
    TRY(next = NEW_ARRAY(int64_t, grid->columns, err));
    TRY(grid->values = NEW_ARRAY(float, (int64_t)grid->rows * grid->columns, err));
    if (data->slip) {
        columns_mean(data, grid, by_column);
    } else {
        columns_gather(data, grid, by_column, next);

        // Before the first step of the history there is nothing; in a long step there is its end.
        int64_t first = 0;
        while (first < data->rows && !isfinite(data->U[first])) ++first;
        for (int32_t column = 0; column < grid->columns; ++column)
            if (next[column] > first && next[column] < data->rows)
                step_add(data, next[column], column, by_column);
    }

    // The largest of the nodes that are seen in the pixels of a row; none: NaN.
    double pixel = (grid->x_high - grid->x_low) / grid->rows;
    for (int32_t row = 0; row < grid->rows; ++row) {
        float *most = grid->values + (int64_t)row * grid->columns;
        double x = grid->x_high - (row + 0.5) * pixel, from = 0, to = 0;
        for (int32_t column = 0; column < grid->columns; ++column) most[column] = NAN;
        for (int32_t i = 0; i < data->nodes; ++i) {
            node_extent(data, i, &from, &to);
            bool near = data->x[i] >= x - pixel / 2 && data->x[i] < x + pixel / 2;
            if (!near && !(x >= from && x < to)) continue;
            for (int32_t column = 0; column < grid->columns; ++column)
                most[column] = larger(most[column], by_column[(int64_t)column * data->nodes + i]);
        }
        for (int32_t column = 0; data->sign < 0 && column < grid->columns; ++column)
            most[column] = -most[column];
    }
cleanup:
    memory_free_all(by_column, next);
    return error_is_clean(err);
}

void pixel_grid_destroy(PixelGrid *grid)
{
    memory_free(grid->values);
    grid->values = NULL;
}
