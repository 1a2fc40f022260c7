// SPDX-License-Identifier: GPL-2.0-or-later
// Block by block, A T first: of the rows that touch a block's, listed by the blocks that they are
// in.
#include "reduction/transform.h"

#include "algebra/dense.h"
#include "base/memory.h"
#include "base/order.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool transform_create(int32_t size, int32_t blocks, int64_t entries, Transform *by, Error *err)
{
    *by = (Transform){.size = size,
                      .blocks = NEW_ARRAY(TransformBlock, blocks, err),
                      .rows = NEW_ARRAY(int32_t, size, err),
                      .values = NEW_ARRAY(double, entries, err),
                      .block_of = NEW_ARRAY(int32_t, size, err),
                      .place = NEW_ARRAY(int32_t, size, err)};
    if (!error_is_clean(err)) return false;
    for (int32_t k = 0; k < size; k++) by->block_of[k] = by->place[k] = NO_BLOCK;
    return true;
}

void transform_destroy(Transform *by)
{
    memory_free_all(by->blocks, by->rows, by->values, by->block_of, by->place);
    *by = (Transform){0};
}

double *transform_append(Transform *by, const int32_t *rows, int32_t size, int32_t count)
{
    TransformBlock *block = &by->blocks[by->block_count];
    *block = (TransformBlock){size, count, by->count, by->rows, by->values};
    if (by->block_count > 0) {
        block->rows = block[-1].rows + block[-1].size;
        block->values = block[-1].values + (int64_t)block[-1].size * block[-1].count;
    }
    for (int32_t i = 0; i < size; i++) {
        block->rows[i] = rows[i];
        by->block_of[rows[i]] = by->block_count;
        by->place[rows[i]] = (int32_t)(block->rows + i - by->rows);
    }
    by->block_count++;
    by->count += count;
    by->row_count += size;
    return block->values;
}

void transform_append_images(Transform *by, const int32_t *rows, int32_t count, const double *signs)
{
    double *values = transform_append(by, rows, count, 1);
    for (int32_t k = 0; k < count; k++) values[k] = signs[k] * sqrt(1.0 / count);
}

int32_t transform_column(const Transform *by, int32_t row)
{
    int32_t block = by->block_of[row];
    return block == NO_BLOCK ? NO_BLOCK : by->blocks[block].first;
}

// Blocks of one column: a block's number is its column, a row's place that of its value.
void transform_apply(const Transform *by, const double *y, double *x)
{
    for (int32_t k = 0; !by->blocks && k < by->size; k++) x[k] += y[k];
    for (int32_t k = 0; k < by->row_count; k++)
        x[by->rows[k]] += by->values[k] * y[by->block_of[by->rows[k]]];
}

void transform_apply_transposed(const Transform *by, const double *x, double *y)
{
    if (!by->blocks) memcpy(y, x, (size_t)by->size * sizeof *y);
    if (by->blocks) memset(y, 0, (size_t)by->count * sizeof *y);
    for (int32_t k = 0; k < by->row_count; k++)
        y[by->block_of[by->rows[k]]] += by->values[k] * x[by->rows[k]];
}

void transform_add_square(const Transform *by, const double *s, int32_t j, double *column)
{
    int32_t at = by->blocks ? by->block_of[j] : j;
    if (at == NO_BLOCK) return;
    const double *from = s + (int64_t)at * by->count;
    if (!by->blocks) dense_add_scaled(1, from, by->size, column);
    for (const TransformBlock *b = by->blocks; b < by->blocks + by->block_count; b++) {
        double moved = by->values[by->place[j]] * from[b->first];
        for (int32_t i = 0; i < b->size; i++) column[b->rows[i]] += b->values[i] * moved;
    }
}

bool transform_apply_many(const Transform *by, const double *y, int32_t columns, double *x,
                          Error *err)
{
    double *moved = NULL, *fields = NULL;
    for (const TransformBlock *b = by->blocks; b < by->blocks + by->block_count; b++) {
        memory_free_all(moved, fields);
        moved = NEW_ARRAY(double, (int64_t)b->count *columns, err);
        fields = NEW_ARRAY(double, (int64_t)b->size *columns, err);
        if (!moved || !fields) break;
        for (int64_t j = 0; j < columns; j++)
            memcpy(moved + j * b->count, y + j * by->count + b->first,
                   (size_t)b->count * sizeof *y);
        dense_multiply_transposed(dense_view(b->values, b->count, b->size),
                                  dense_view(moved, b->count, columns), 1, 0, fields);
        for (int64_t j = 0; j < columns; j++)
            for (int64_t i = 0; i < b->size; i++)
                x[j * by->size + b->rows[i]] = fields[j * b->size + i];
    }
    memory_free_all(moved, fields);
    return error_is_clean(err);
}

// --- T'AT ---------------------------------------------------------------------------------------

typedef struct Congruence {
    const SparsePattern *from;
    const Transform *by;
    SparsePattern *to;
    int32_t *listed, listed_count;   // [size] places of those that touch a block, ascending
    int32_t *slot;   // [size] where on that list a place is, if it is there
    int64_t most_listed, most_columns;   // of any block
    double *image;   // [listed * columns] A T of a block, row after row
    double *moved;   // [rows * columns] T of rows listed, of one block
    double *product;   // [columns^2]
} Congruence;

static void list_touched(Congruence *work, const TransformBlock *block)
{
    const SparsePattern *from = work->from;
    int32_t *listed = work->listed, *slot = work->slot, end = 0;
    for (int32_t i = 0; i < block->size; i++) {
        for (int32_t at = from->start[block->rows[i]]; at < from->start[block->rows[i] + 1]; at++) {
            int32_t place = work->by->place[from->index[at]];
            if (place == NO_BLOCK || (slot[place] < end && listed[slot[place]] == place)) continue;
            slot[place] = end;
            listed[end++] = place;
        }
    }
    qsort(listed, (size_t)end, sizeof *listed, order_int32);
    for (int32_t i = 0; i < end; i++) slot[listed[i]] = i;
    work->listed_count = end;
}

// Finds the block of the row listed at `start`, and where the rows of this block end in the list.
static const TransformBlock *next_block(const Congruence *work, int32_t start, int32_t *end)
{
    const Transform *by = work->by;
    const TransformBlock *block = &by->blocks[by->block_of[by->rows[work->listed[start]]]];
    int32_t last = (int32_t)(block->rows + block->size - by->rows);
    for (*end = start; *end < work->listed_count && work->listed[*end] < last;) (*end)++;
    return block;
}

// A block's columns with all blocks up to itself, and what faces them.
static void fill_values(const Congruence *work, const TransformBlock *block, const double *from,
                        double *to)
{
    const SparsePattern *pattern = work->from;
    int64_t columns = block->count;
    memset(work->image, 0, (size_t)(work->listed_count * columns) * sizeof *work->image);
    for (int32_t i = 0; i < block->size; i++) {
        const double *row = block->values + i * columns;
        for (int32_t at = pattern->start[block->rows[i]]; at < pattern->start[block->rows[i] + 1];
             at++) {
            int32_t place = work->by->place[pattern->index[at]];
            if (place == NO_BLOCK) continue;
            double *out = work->image + work->slot[place] * columns;
            for (int64_t j = 0; j < columns; j++) out[j] += from[at] * row[j];
        }
    }
    for (int32_t start = 0, end; start < work->listed_count; start = end) {
        const TransformBlock *other = next_block(work, start, &end);
        if (other > block) break;

        // Their product [other's columns * block's], row after row.
        double *product = work->product;
        int64_t count = other->count;
        memset(product, 0, (size_t)(count * columns) * sizeof *product);
        for (int32_t k = start; k < end; k++) {
            const double *row = other->values +
                                (work->listed[k] - (other->rows - work->by->rows)) * count;
            const double *image = work->image + k * columns;
            for (int64_t j = 0; count == 1 && j < columns; j++) product[j] += row[0] * image[j];
            memcpy(work->moved + (k - start) * count, row, (size_t)count * sizeof *row);
        }
        if (count > 1)
            dense_multiply_by_transposed(
                dense_view(work->image + start * columns, columns, end - start),
                dense_view(work->moved, count, end - start), product);

        // The product goes into rows and columns of both blocks.
        if (other == block) dense_mirror(product, columns);
        for (int32_t i = 0; i < count; i++)
            memcpy(to + sparse_entry(work->to, other->first + i, block->first),
                   product + i * columns, (size_t)columns * sizeof *product);
        for (int32_t j = 0; other != block && j < columns; j++) {
            double *out = to + sparse_entry(work->to, block->first + j, other->first);
            for (int32_t i = 0; i < count; i++) out[i] = product[i * columns + j];
        }
    }
}

static bool transform_matrices(const Bulk *from, const Transform *by, Bulk *to, Error *err)
{
    Congruence work = {.from = &from->pattern,
                       .by = by,
                       .to = &to->pattern,
                       .listed = NEW_ARRAY(int32_t, by->size, err),
                       .slot = NEW_ARRAY(int32_t, by->size, err)};
    to->pattern = (SparsePattern){.size = by->count,
                                  .start = NEW_ARRAY(int32_t, (int64_t)by->count + 1, err)};
    if (!error_is_clean(err)) goto cleanup;

    // Count the entries of each column.
    int64_t entries = 0;
    for (const TransformBlock *block = by->blocks; block < by->blocks + by->block_count; block++) {
        int64_t touched = 0;
        list_touched(&work, block);
        for (int32_t start = 0, end; start < work.listed_count; start = end)
            touched += next_block(&work, start, &end)->count;
        if (work.listed_count > work.most_listed) work.most_listed = work.listed_count;
        if (block->count > work.most_columns) work.most_columns = block->count;
        for (int32_t j = block->first; j < block->first + block->count; j++) {
            entries += touched;
            if (entries > INT32_MAX) FAIL(err, ERROR_COMPUTE, "too many entries are left");
            to->pattern.start[j + 1] = (int32_t)entries;
        }
    }
    int64_t columns = work.most_columns;
    to->pattern.index = NEW_ARRAY(int32_t, entries, err);
    to->stiffness = NEW_ARRAY(double, entries, err);
    to->damping = NEW_ARRAY(double, entries, err);
    if (from->mass_beside) to->mass_beside = NEW_ARRAY(double, entries, err);
    to->spectrum = from->spectrum;
    for (int32_t j = 0; j < from->spectrum.matrix_count; j++)
        to->shape[j] = NEW_ARRAY(double, entries, err);
    work.image = NEW_ARRAY(double, work.most_listed *columns, err);
    work.moved = NEW_ARRAY(double, work.most_listed *columns, err);
    work.product = NEW_ARRAY(double, columns *columns, err);
    if (!error_is_clean(err)) goto cleanup;
    for (const TransformBlock *b = by->blocks; b < by->blocks + by->block_count; b++) {
        list_touched(&work, b);
        for (int32_t j = b->first; j < b->first + b->count; j++) {
            int32_t at = to->pattern.start[j];
            for (int32_t start = 0, end; start < work.listed_count; start = end) {
                const TransformBlock *other = next_block(&work, start, &end);
                for (int32_t i = 0; i < other->count; i++)
                    to->pattern.index[at++] = other->first + i;
            }
        }
        fill_values(&work, b, from->stiffness, to->stiffness);
        fill_values(&work, b, from->damping, to->damping);
        if (from->mass_beside) fill_values(&work, b, from->mass_beside, to->mass_beside);
        for (int32_t j = 0; j < from->spectrum.matrix_count; j++)
            fill_values(&work, b, from->shape[j], to->shape[j]);
    }
cleanup:
    memory_free_all(work.listed, work.slot, work.image, work.moved, work.product);
    return error_is_clean(err);
}

bool bulk_transform(const Bulk *from, const Transform *by, Bulk *to, Error *err)
{
    *to = (Bulk){.dof_count = by->count,
                 .mass = NEW_ARRAY(double, by->count, err),
                 .load = NEW_ARRAY(double, by->count, err),
                 .held = NEW_ARRAY(uint8_t, by->count, err)};
    if (from->place) to->place = NEW_ARRAY(double, 3 * (int64_t)by->count, err);
    if (!error_is_clean(err) || !transform_matrices(from, by, to, err)) return false;
    for (const TransformBlock *b = by->blocks; b < by->blocks + by->block_count; b++) {
        for (int64_t j = 0; j < b->count; j++) {
            bool held = true;
            for (int32_t i = 0; i < b->size; i++) {
                double value = b->values[i * b->count + j];
                to->mass[b->first + j] += value * value * from->mass[b->rows[i]];
                to->load[b->first + j] += value * from->load[b->rows[i]];
                held = held && from->held[b->rows[i]];
            }
            to->held[b->first + j] = held;
            if (to->place)   // that of the first unknown it is made of
                memcpy(to->place + 3 * (b->first + j), from->place + 3 * (int64_t)b->rows[0],
                       3 * sizeof(double));
        }
    }
    return true;
}
