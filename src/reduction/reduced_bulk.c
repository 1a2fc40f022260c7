// SPDX-License-Identifier: GPL-2.0-or-later
#include "reduction/reduced_bulk.h"

#include "algebra/dense.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

int32_t rigid_count(int32_t dim)
{
    return dim * (dim + 1) / 2;
}

double rigid_motion(int32_t dim, int32_t which, const double *place, int32_t axis)
{
    if (which < dim) return axis == which;
    int32_t a = 0, b = dim - 1;
    for (int32_t left = which - dim; left > 0; left--)
        if (--b == a) a++, b = dim - 1;
    return axis == a ? -place[b] : axis == b ? place[a] : 0;
}

void reduced_part_destroy(ReducedPart *part)
{
    memory_free_all(part->stiffness, part->mass, part->coupling, part->masses, part->damping,
                    part->load, part->modes);
    for (int32_t j = 0; j < part->shape_count; j++) memory_free(part->shape[j]);
    transform_destroy(&part->border);
    transform_destroy(&part->mesh);
    *part = (ReducedPart){0};
}

void reduced_bulk_destroy(ReducedBulk *reduced)
{
    for (int p = 0; p < REDUCED_PARTS_MAX; p++) reduced_part_destroy(&reduced->part[p]);
    memory_free_all(reduced->load, reduced->rigid);
    *reduced = (ReducedBulk){0};
}

// [z; q] of a part. interior: of x, where its q begins. Returns where the next part's begins.
static const double *take_part(const ReducedPart *part, const double *x, const double *interior,
                               double *local)
{
    transform_apply_transposed(&part->border, x, local);
    memcpy(local + part->border_count, interior, (size_t)part->interior_count * sizeof *interior);
    return interior + part->interior_count;
}

void reduced_bulk_split(const ReducedBulk *reduced, const double *x, double *const *local)
{
    const double *interior = x + reduced->interface_count + reduced->mirrored;
    for (int p = 0; p < reduced->part_count; p++)
        interior = take_part(&reduced->part[p], x, interior, local[p]);
}

void reduced_bulk_join(const ReducedBulk *reduced, const double *const *local, double *x)
{
    int32_t border = reduced->interface_count + reduced->mirrored;
    double *interior = x + border;
    memset(x, 0, (size_t)border * sizeof *x);
    for (int p = 0; p < reduced->part_count; p++) {
        const ReducedPart *part = &reduced->part[p];
        transform_apply(&part->border, local[p], x);
        memcpy(interior, local[p] + part->border_count,
               (size_t)part->interior_count * sizeof *interior);
        interior += part->interior_count;
    }
}

// Part by part, so that its modes come from memory once for all states.
bool reduced_bulk_recover(const ReducedBulk *reduced, int32_t count, const double *const *states,
                          double *const *full, Error *err)
{
    int64_t interior = reduced->interface_count + reduced->mirrored;
    double *storage = NULL, **local = NEW_ARRAY(double *, count, err);
    double **field = NEW_ARRAY(double *, count, err);
    if (!error_is_clean(err)) goto cleanup;
    for (int32_t k = 0; k < count; k++)
        memset(full[k], 0, (size_t)reduced->full_dofs * sizeof(double));
    for (int p = 0; p < reduced->part_count; p++) {
        const ReducedPart *part = &reduced->part[p];
        int64_t size = part->count + part->full_dofs;
        memory_free(storage);
        TRY((storage = memory_bytes(8 * size * count, err)));
        for (int32_t k = 0; k < count; k++) {
            local[k] = storage + k * size;
            field[k] = local[k] + part->count;
            take_part(part, states[k], states[k] + interior, local[k]);
        }
        interior += part->interior_count;
        dense_apply_each((DenseView){part->modes, part->full_dofs, part->count}, count,
                         (const double *const *)local, field);
        for (int32_t k = 0; k < count; k++) transform_apply(&part->mesh, field[k], full[k]);
    }
cleanup:
    memory_free_all(storage, local, field);
    return error_is_clean(err);
}

// The border and the interior of a part are joined as forces are: by the transpose of what splits
// motions.
bool reduced_bulk_project(const ReducedBulk *reduced, const double *full, double *row, Error *err)
{
    double *local[REDUCED_PARTS_MAX] = {0}, *field = NULL;
    for (int p = 0; p < reduced->part_count; p++) {
        const ReducedPart *part = &reduced->part[p];
        memory_free(field);
        TRY((field = NEW_ARRAY(double, part->full_dofs, err)));
        TRY((local[p] = NEW_ARRAY(double, part->count, err)));
        transform_apply_transposed(&part->mesh, full, field);
        dense_apply_transposed((DenseView){part->modes, part->full_dofs, part->count}, field, 1, 0,
                               local[p]);
    }
    reduced_bulk_join(reduced, (const double *const *)local, row);
cleanup:
    memory_free(field);
    memory_free_list((void *const *)local, REDUCED_PARTS_MAX);
    return error_is_clean(err);
}

// Between two levels the error is not measured; it stays below the larger of theirs, or little
// above (a test asks at random: 1.2 times as large, of two materials).
static const double BETWEEN = 1.5;

double reduced_bulk_error(const ReducedBulk *reduced, double inertia)
{
    double error = 0;
    for (int p = 0; p < reduced->part_count; p++) {
        const ReductionErrors *errors = &reduced->part[p].errors;
        int32_t above = 0;
        if (errors->count == 0) continue;
        while (above < errors->count - 1 && errors->inertia[above] < inertia) above++;
        double below = above > 0 ? errors->error[above - 1] : 0;
        error = fmax(error, BETWEEN * fmax(below, errors->error[above]));
    }
    return error;
}
