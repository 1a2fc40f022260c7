// SPDX-License-Identifier: GPL-2.0-or-later
// Other unknowns y for those of a bulk, x = T y: images at a mirror line, few modes in place of
// what is far from the interface. T is sparse, its columns in blocks of the same rows; each row is
// in one block, or in none: that unknown stays 0. Called by reduction/mirror, reduction/far_field
// and reduction/reduction.
#ifndef AMONTONS_REDUCTION_TRANSFORM_H
#define AMONTONS_REDUCTION_TRANSFORM_H

#include "fem/assembly.h"

typedef struct TransformBlock {
    int32_t size, count;   // rows, columns
    int32_t first;   // column
    int32_t *rows;   // [size] unknowns of x
    double *values;   // [size * count], row after row
} TransformBlock;

enum { NO_BLOCK = -1 };

typedef struct Transform {
    int32_t size, count;   // of x and y
    int32_t block_count;
    TransformBlock *blocks;   // [block_count] owned, like all below; NULL: T = 1
    int32_t row_count, *rows;   // [row_count] of all blocks
    double *values;
    int32_t *block_of, *place;   // [size] block of each x, where it is in `rows`; NO_BLOCK: none
} Transform;

// Room for `blocks` of `entries` in all; none yet.
bool transform_create(int32_t size, int32_t blocks, int64_t entries, Transform *by, Error *err);
void transform_destroy(Transform *by);
// The values of one more block, to be filled; each row is new.
double *transform_append(Transform *by, const int32_t *rows, int32_t size, int32_t count);
// One more column, the sum of signs x over sqrt(count), of an unknown and its images.
void transform_append_images(Transform *by, const int32_t *rows, int32_t count,
                             const double *signs);
// Place among y where an unknown's block begins; NO_BLOCK: it has none.
int32_t transform_column(const Transform *by, int32_t row);

// Three where blocks have one column each, or T is 1.
void transform_apply(const Transform *by, const double *y, double *x);   // x += T y
void transform_apply_transposed(const Transform *by, const double *x, double *y);   // y = T'x
// column [size] += column j of T s T', of a symmetric s [count^2]
void transform_add_square(const Transform *by, const double *s, int32_t j, double *column);
// x = T y of `columns` columns; x starts at 0.
bool transform_apply_many(const Transform *by, const double *y, int32_t columns, double *x,
                          Error *err);

// T'KT, T'CT, T'f and the diagonal of T'MT: no more than that may be there. Held is what all of a
// block's unknowns are.
bool bulk_transform(const Bulk *from, const Transform *by, Bulk *to, Error *err);

#endif
