// SPDX-License-Identifier: GPL-2.0-or-later
#include "algebra/sparse.h"

#include "base/memory.h"

#include <cholmod.h>

void sparse_pattern_destroy(SparsePattern *pattern)
{
    memory_free_all(pattern->start, pattern->index);
    *pattern = (SparsePattern){0};
}

// Turns a pattern of points into one of unknowns: each neighbour gives `width` columns, and the
// rows of a point are alike.
static bool couple_unknowns(const cholmod_sparse *pairs, int32_t width, SparsePattern *pattern,
                            Error *err)
{
    const int32_t *first = pairs->p, *neighbour = pairs->i;
    int32_t points = (int32_t)pairs->ncol, filled = 0;
    pattern->size = width * points;
    pattern->start = NEW_ARRAY(int32_t, (int64_t)pattern->size + 1, err);
    pattern->index = NEW_ARRAY(int32_t, (int64_t)width * width * first[points], err);
    for (int32_t row = 0; error_is_clean(err) && row < pattern->size; row++) {
        for (int32_t k = first[row / width]; k < first[row / width + 1]; k++)
            for (int32_t d = 0; d < width; d++) pattern->index[filled++] = width * neighbour[k] + d;
        pattern->start[row + 1] = filled;
    }
    return error_is_clean(err);
}

// With B [points * groups] the entries of B B' are the pairs of points.
bool sparse_pattern_of_groups(const PointGroups *groups, int32_t width, SparsePattern *pattern,
                              Error *err)
{
    cholmod_common common;
    cholmod_sparse b = {.nrow = (size_t)groups->points,
                        .ncol = (size_t)groups->count,
                        .nzmax = (size_t)groups->start[groups->count],
                        .p = groups->start,
                        .i = groups->member,
                        .itype = CHOLMOD_INT,
                        .xtype = CHOLMOD_PATTERN,
                        .packed = 1};
    cholmod_start(&common);
    common.print = 0;
    cholmod_sparse *pairs = cholmod_aat(&b, NULL, 0, 0, &common);
    bool done = pairs && cholmod_sort(pairs, &common);
    if (!done)
        error_set(err, ERROR_MEMORY, __FILE__, __LINE__, "no memory for the pattern of %d unknowns",
                  width * groups->points);
    done = done && couple_unknowns(pairs, width, pattern, err);
    cholmod_free_sparse(&pairs, &common);
    cholmod_finish(&common);
    return done;
}

// Bisection: the columns of a row are ascending.
int32_t sparse_entry(const SparsePattern *pattern, int32_t row, int32_t column)
{
    int32_t low = pattern->start[row], high = pattern->start[row + 1] - 1;
    while (low < high) {
        int32_t middle = (low + high) / 2;
        if (pattern->index[middle] < column)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

// Goes by rows, as both triangles are stored: one pass over the values without scattered writes.
void sparse_apply(const SparsePattern *pattern, const double *values, const double *x, double *y)
{
    const int32_t *start = pattern->start, *index = pattern->index;
    for (int32_t row = 0; row < pattern->size; row++) {
        double sum = 0.0;
        for (int32_t k = start[row]; k < start[row + 1]; k++) sum += values[k] * x[index[k]];
        y[row] = sum;
    }
}

static cholmod_dense columns_view(double *x, size_t rows, int64_t columns)
{
    return (cholmod_dense){.nrow = rows,
                           .ncol = (size_t)columns,
                           .nzmax = rows * (size_t)columns,
                           .d = rows,
                           .x = x,
                           .xtype = CHOLMOD_REAL};
}

// Goes by columns of the transpose: four columns of x share a pass over the values.
void sparse_apply_many(const SparsePattern *pattern, const double *values, const double *x,
                       int64_t columns, double *y)
{
    size_t size = (size_t)pattern->size;
    double one[2] = {1, 0}, zero[2] = {0, 0};
    cholmod_common common;
    // CHOLMOD's views are not const; what is multiplied is only read.
    cholmod_sparse a = {.nrow = size,
                        .ncol = size,
                        .nzmax = (size_t)pattern->start[pattern->size],
                        .p = pattern->start,
                        .i = pattern->index,
                        .x = (void *)(uintptr_t)values,
                        .itype = CHOLMOD_INT,
                        .xtype = CHOLMOD_REAL,
                        .sorted = 1,
                        .packed = 1};
    cholmod_dense from = columns_view((double *)(uintptr_t)x, size, columns);
    cholmod_dense to = columns_view(y, size, columns);
    cholmod_start(&common);
    cholmod_sdmult(&a, 1, one, zero, &from, &to, &common);
    cholmod_finish(&common);
}
