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
    memory_free_all(part->mass, part->damping, part->stiffness, part->load, part->modes);
    transform_destroy(&part->border);
    transform_destroy(&part->mesh);
    *part = (ReducedPart){0};
}

void reduced_bulk_destroy(ReducedBulk *reduced)
{
    for (int p = 0; p < REDUCED_PARTS_MAX; p++) {
        ReducedPart *part = &reduced->part[p];
        if (reduced->storage) part->mass = part->damping = part->stiffness = part->load = NULL;
        reduced_part_destroy(part);
    }
    if (!reduced->storage) memory_free(reduced->load);
    memory_free_all(reduced->rigid, reduced->storage);
    *reduced = (ReducedBulk){0};
}

void reduced_bulk_split(const ReducedBulk *reduced, const double *x, double *const *local)
{
    const double *interior = x + reduced->interface_count + reduced->mirrored;
    for (int p = 0; p < reduced->part_count; p++) {
        const ReducedPart *part = &reduced->part[p];
        transform_apply_transposed(&part->border, x, local[p]);
        memcpy(local[p] + part->border_count, interior,
               (size_t)part->interior_count * sizeof *interior);
        interior += part->interior_count;
    }
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

// Work of the parts of several states.
typedef struct Recovery {
    double *storage;
    double **local[REDUCED_PARTS_MAX];   // [count] each of [part's count]
    double **field[REDUCED_PARTS_MAX];   // [count] each of [part's full_dofs]
} Recovery;

static void recovery_destroy(Recovery *work)
{
    for (int p = 0; p < REDUCED_PARTS_MAX; p++) {
        memory_free_all(work->local[p], work->field[p]);
    }
    memory_free(work->storage);
}

static bool recovery_create(const ReducedBulk *reduced, int32_t count, Recovery *work, Error *err)
{
    int64_t size = reduced->count + reduced->mirrored + reduced->full_dofs;
    double *next = work->storage = memory_bytes(8 * size * count, err);
    for (int p = 0; p < reduced->part_count; p++) {
        const ReducedPart *part = &reduced->part[p];
        work->local[p] = NEW_ARRAY(double *, count, err);
        work->field[p] = NEW_ARRAY(double *, count, err);
        for (int32_t k = 0; error_is_clean(err) && k < count; k++) {
            work->local[p][k] = next;
            work->field[p][k] = next + part->count;
            next += part->count + part->full_dofs;
        }
    }
    return error_is_clean(err);
}

bool reduced_bulk_recover(const ReducedBulk *reduced, int32_t count, const double *const *states,
                          double *const *full, Error *err)
{
    Recovery work = {0};
    TRY(recovery_create(reduced, count, &work, err));
    for (int32_t k = 0; k < count; k++) {
        double *local[REDUCED_PARTS_MAX];
        for (int p = 0; p < reduced->part_count; p++) local[p] = work.local[p][k];
        reduced_bulk_split(reduced, states[k], local);
        memset(full[k], 0, (size_t)reduced->full_dofs * sizeof(double));
    }
    for (int p = 0; p < reduced->part_count; p++) {
        const ReducedPart *part = &reduced->part[p];
        dense_apply_each((DenseView){part->modes, part->full_dofs, part->count}, count,
                         (const double *const *)work.local[p], work.field[p]);
        for (int32_t k = 0; k < count; k++) transform_apply(&part->mesh, work.field[p][k], full[k]);
    }
cleanup:
    recovery_destroy(&work);
    return error_is_clean(err);
}

// Between two levels the error is not measured; it stays below the larger of theirs, or little
// above (a test asks at random: 1.2 times as large, of two materials).
static const double BETWEEN = 1.5;

static double part_error(const ReductionErrors *errors, double inertia)
{
    int32_t above = 0;
    if (errors->count == 0) return 0;
    while (above < errors->count - 1 && errors->inertia[above] < inertia) above++;
    double below = above > 0 ? errors->error[above - 1] : 0;
    return BETWEEN * fmax(below, errors->error[above]);
}

double reduced_bulk_error(const ReducedBulk *reduced, double inertia)
{
    double error = 0;
    for (int p = 0; p < reduced->part_count; p++)
        error = fmax(error, part_error(&reduced->part[p].errors, inertia));
    return error;
}
