// SPDX-License-Identifier: GPL-2.0-or-later
// Rows become columns in tiles that stay in the cache: column by column each number of a large
// matrix would come from another page.
#include "algebra/dense.h"

enum { TILE = 32 };

static int64_t end_of(int64_t from, int64_t size)
{
    return from + TILE < size ? from + TILE : size;
}

void dense_transpose(DenseView a, double *out, int64_t stride)
{
    for (int64_t left = 0; left < a.columns; left += TILE)
        for (int64_t top = 0; top < a.rows; top += TILE)
            for (int64_t i = top; i < end_of(top, a.rows); i++)
                for (int64_t j = left; j < end_of(left, a.columns); j++)
                    out[i * stride + j] = a.values[j * a.rows + i];
}

void dense_mirror(double *a, int64_t n)
{
    for (int64_t left = 0; left < n; left += TILE)
        for (int64_t top = left; top < n; top += TILE)
            for (int64_t i = top; i < end_of(top, n); i++)
                for (int64_t j = left; j < end_of(left, n) && j < i; j++)
                    a[i * n + j] = a[j * n + i];
}
