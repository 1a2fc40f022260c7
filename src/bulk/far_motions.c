// SPDX-License-Identifier: GPL-2.0-or-later
#include "bulk/far_motions.h"

#include "base/dense.h"
#include "base/memory.h"
#include "base/share.h"

#include <math.h>
#include <string.h>

enum { TOGETHER = 48 };   // columns whose image is formed at once

// Of the largest energy of some fields: what has less is looked at again when the others are taken
// out, or half of its digits would be lost.
static const double DIGITS = 1e-8;

// Of the squares of some fields: taken out once more where less is left.
static const double LITTLE = 1e-4;

void far_motions_destroy(FarMotions *motions)
{
    memory_free(motions->dofs);
    sparse_pattern_destroy(&motions->pattern);
    memory_free(motions->stiffness);
    memory_free(motions->damping);
    memory_free(motions->field);
    memory_free(motions->image);
    memory_free(motions->rows);
    memory_free(motions->next);
    memory_free(motions->work[0]);
    memory_free(motions->work[1]);
    *motions = (FarMotions){0};
}

// place: [bulk->dof_count] where an unknown stands in the layer; -1: it is none of it.
static bool copy_matrices(const Bulk *bulk, const int32_t *place, double unit, FarMotions *motions,
                          Error *err)
{
    const SparsePattern *from = &bulk->pattern;
    const int32_t *dofs = motions->dofs;
    int32_t size = motions->size, entries = 0;
    for (int32_t j = 0; j < size; j++) entries += from->start[dofs[j] + 1] - from->start[dofs[j]];
    motions->pattern = (SparsePattern){.size = size,
                                       .start = NEW_ARRAY(int32_t, (int64_t)size + 1, err),
                                       .index = NEW_ARRAY(int32_t, entries, err)};
    motions->stiffness = NEW_ARRAY(double, entries, err);
    motions->damping = NEW_ARRAY(double, entries, err);
    if (!error_is_clean(err)) return false;
    int32_t filled = 0;
    for (int32_t j = 0; j < size; j++) {
        for (int32_t k = from->start[dofs[j]]; k < from->start[dofs[j] + 1]; k++) {
            if (place[from->index[k]] < 0) continue;
            motions->pattern.index[filled] = place[from->index[k]];
            motions->stiffness[filled] = bulk->stiffness[k] / unit;
            motions->damping[filled++] = bulk->damping[k];
        }
        motions->pattern.start[j + 1] = filled;
    }
    return true;
}

// Not zeroed: what is not written to stays without memory behind it.
static bool lengthen(double **columns, int64_t filled, int64_t needed, Error *err)
{
    double *longer = memory_bytes(needed * (int64_t)sizeof *longer, err);
    if (!longer) return false;
    if (filled > 0) memcpy(longer, *columns, (size_t)filled * sizeof *longer);
    memory_free(*columns);
    *columns = longer;
    return true;
}

static bool make_room(FarMotions *motions, int32_t columns, Error *err)
{
    int64_t size = motions->size, filled = size * motions->count;
    int64_t room = motions->room, needed = motions->count + columns;
    if (needed <= room) return true;
    if (needed < 2 * room) needed = 2 * room;
    if (!lengthen(&motions->field, filled, size * needed, err) ||
        !lengthen(&motions->image, filled, size * needed, err))
        return false;
    motions->room = (int32_t)needed;
    return true;
}

bool far_motions_begin(const Bulk *bulk, double unit, int32_t expected, FarMotions *motions,
                       Error *err)
{
    int64_t size = motions->size;
    motions->rows = NEW_ARRAY(double, size * motions->columns_max, err);
    motions->next = NEW_ARRAY(double, size * motions->columns_max, err);
    for (int which = 0; which < 2; which++)
        motions->work[which] = NEW_ARRAY(double, size *SPARSE_WIDE, err);
    if (!error_is_clean(err)) return false;
    int32_t *place = NEW_ARRAY(int32_t, bulk->dof_count, err);
    if (!place) return false;
    for (int32_t k = 0; k < bulk->dof_count; k++) place[k] = -1;
    for (int32_t j = 0; j < motions->size; j++) place[motions->dofs[j]] = j;
    bool done = make_room(motions, expected, err) && copy_matrices(bulk, place, unit, motions, err);
    memory_free(place);
    return done;
}

static double square_sum(const double *values, int64_t count)
{
    double sum = 0;
    for (int64_t k = 0; k < count; k++) sum += values[k] * values[k];
    return sum;
}

// Fields less what F has of them, and their image; each thread does half of the columns, and takes
// their rows out of the mesh's first.
// Twice where little is left: what rounding put back is large beside it.
typedef struct Remainder {
    const FarMotions *motions;
    int32_t columns;
    const double *whole;   // [mesh_dofs * columns]; NULL: their rows are in `fields`
    int64_t mesh_dofs;
    double *fields, *image;   // [size * columns]
    double least;   // energy of what is taken up
    int32_t added;
    bool again;   // some have few digits
    double *parts;   // [count * columns] work
} Remainder;

static void take_out_half(void *context, int32_t which)
{
    const Remainder *all = context;
    const FarMotions *motions = all->motions;
    int64_t size = motions->size, count = motions->count;
    int64_t first = which ? all->columns / 2 : 0, end = which ? all->columns : all->columns / 2;
    double *fields = all->fields + first * size, *parts = all->parts + first * count;
    DenseView all_motions = dense_view(motions->field, size, count);
    for (int64_t j = first; all->whole && j < end; j++)
        for (int64_t i = 0; i < size; i++)
            all->fields[j * size + i] = all->whole[j * all->mesh_dofs + motions->dofs[i]];
    for (bool again = count > 0; again;) {
        double before = square_sum(fields, size * (end - first));
        dense_multiply_transposed(dense_view(motions->image, size, count),
                                  dense_view(fields, size, end - first), 1, 0, parts);
        dense_multiply(all_motions, dense_view(parts, count, end - first), -1, 1, fields);
        double after = square_sum(fields, size * (end - first));
        again = after > 0 && after < LITTLE * before;
    }
    sparse_apply_many(&motions->pattern, motions->stiffness, fields, end - first,
                      all->image + first * size, motions->work[which]);
}

// New columns of F and its image: those of `fields` times eigenvectors of their energies.
static bool take_up(FarMotions *motions, Remainder *all, Error *err)
{
    const double *fields = all->fields, *image = all->image;
    int32_t columns = all->columns;
    int64_t size = motions->size, c = columns;
    double *energies = NEW_ARRAY(double, c *c, err), *values = NEW_ARRAY(double, c, err);
    double *work = NEW_ARRAY(double, dense_eigen_work(columns), err);
    if (!energies || !values || !work) goto cleanup;
    dense_multiply_transposed(dense_view(fields, size, c), dense_view(image, size, c), 1, 0,
                              energies);
    if (!dense_eigen(energies, columns, values, work))
        FAIL(err, ERROR_LIBRARY, "LAPACK: no energies of motions far from the interface");
    int64_t first = c;
    double enough = fmax(all->least, DIGITS * values[c - 1]);
    while (first > 0 && values[first - 1] > enough) first--;
    all->again = first > 0 && values[first - 1] > all->least;
    for (int64_t j = first; j < c; j++)
        for (int64_t i = 0; i < c; i++) energies[j * c + i] /= sqrt(values[j]);
    DenseView kept = dense_view(energies + first * c, c, c - first);
    int64_t end = size * motions->count;
    dense_multiply(dense_view(fields, size, c), kept, 1, 0, motions->field + end);
    dense_multiply(dense_view(image, size, c), kept, 1, 0, motions->image + end);
    all->added += (int32_t)(c - first);
    motions->count += (int32_t)(c - first);
cleanup:
    memory_free(energies);
    memory_free(values);
    memory_free(work);
    return error_is_clean(err);
}

bool far_motions_add(FarMotions *motions, DenseView fields, double least, int32_t *added,
                     Error *err)
{
    int32_t columns = fields.columns;
    if (!make_room(motions, columns, err)) return false;
    Remainder all = {.motions = motions,
                     .columns = columns,
                     .least = least,
                     .whole = fields.values,
                     .mesh_dofs = fields.rows,
                     .fields = motions->rows,
                     .image = motions->next,
                     .parts = NEW_ARRAY(double, (int64_t)motions->room *columns, err)};
    if (!all.parts) goto cleanup;
    do {
        share_in_two(take_out_half, &all);
        all.whole = NULL;
        TRY(take_up(motions, &all, err));
    } while (all.again && all.added < columns);
    *added = all.added;
cleanup:
    memory_free(all.parts);
    return error_is_clean(err);
}

// One half of the products: of every second pass, from its first column down, as they are
// symmetric.
typedef struct Projection {
    const FarMotions *motions;
    const double *mass;
    double *const *square;
    double *image[2];   // [size * TOGETHER]
} Projection;

static void project_half(void *context, int32_t which)
{
    const Projection *all = context;
    const FarMotions *motions = all->motions;
    int64_t size = motions->size, count = motions->count;
    double *image = all->image[which];
    for (int64_t from = which * TOGETHER; from < count; from += 2 * TOGETHER) {
        int64_t columns = count - from < TOGETHER ? count - from : TOGETHER,
                at = from * (count + 1);
        const double *field = motions->field + from * size;
        DenseView rest = dense_view(field, size, count - from),
                  part = dense_view(image, size, columns);
        dense_multiply_transposed_rows(rest,
                                       dense_view(motions->image + from * size, size, columns), 1,
                                       0, all->square[BULK_STIFFNESS] + at, count);
        sparse_apply_many(&motions->pattern, motions->damping, field, columns, image,
                          motions->work[which]);
        dense_multiply_transposed_rows(rest, part, 1, 0, all->square[BULK_DAMPING] + at, count);
        for (int64_t j = 0; j < columns; j++)
            for (int64_t i = 0; i < size; i++)
                image[j * size + i] = all->mass[motions->dofs[i]] * field[j * size + i];
        dense_multiply_transposed_rows(rest, part, 1, 0, all->square[BULK_MASS] + at, count);
    }
}

static void mirror(double *square, int64_t count)
{
    for (int64_t j = 0; j < count; j++)
        for (int64_t i = 0; i < j; i++) square[j * count + i] = square[i * count + j];
}

bool far_motions_project(const FarMotions *motions, const double *mass,
                         double *const square[BULK_TERMS], Error *err)
{
    int64_t size = motions->size;
    Projection all = {.motions = motions, .mass = mass, .square = square};
    for (int which = 0; which < 2; which++)
        all.image[which] = NEW_ARRAY(double, size *TOGETHER, err);
    if (!error_is_clean(err)) goto cleanup;
    share_in_two(project_half, &all);
    for (int term = 0; term < BULK_TERMS; term++) mirror(square[term], motions->count);
cleanup:
    for (int which = 0; which < 2; which++) memory_free(all.image[which]);
    return error_is_clean(err);
}
