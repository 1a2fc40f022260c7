// SPDX-License-Identifier: GPL-2.0-or-later
#include "reduction/reduced_bulk.h"

#include "base/dense.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

// Those that lie in the whole's storage.
static void forget_matrices(ReducedBulk *half)
{
    half->mass = half->damping = half->stiffness = half->viscous = half->load = NULL;
}

void reduced_bulk_destroy(ReducedBulk *reduced)
{
    for (int h = 0; reduced->half && h < 2; h++) {
        if (reduced->storage) forget_matrices(&reduced->half[h]);
        reduced_bulk_destroy(&reduced->half[h]);
    }
    if (reduced->storage) forget_matrices(reduced);
    memory_free(reduced->storage);
    memory_free(reduced->mass);
    memory_free(reduced->damping);
    memory_free(reduced->stiffness);
    memory_free(reduced->viscous);
    memory_free(reduced->load);
    memory_free(reduced->modes);
    if (reduced->halves) halves_destroy(reduced->halves);
    memory_free(reduced->halves);
    memory_free(reduced->half);
    *reduced = (ReducedBulk){0};
}

void reduced_bulk_set_scales(ReducedBulk *reduced, BulkScales scales)
{
    reduced->scales = scales;
    for (int h = 0; reduced->half && h < 2; h++) reduced->half[h].scales = scales;
}

bool reduced_bulk_has_modes(const ReducedBulk *reduced)
{
    return reduced->half ? reduced->half[0].modes : reduced->modes;
}

static void apply_modes(const ReducedBulk *reduced, int32_t count, const double *const *states,
                        double *const *full)
{
    DenseView modes = {reduced->modes, reduced->full_dofs, reduced->count};
    dense_apply_each(modes, count, states, full);
}

// Work of the halves of several states.
typedef struct Recovery {
    double *storage, **local[2], **field[2];   // [count] each of [half's count], [half's full_dofs]
    double *border;
} Recovery;

static void recovery_destroy(Recovery *work)
{
    for (int h = 0; h < 2; h++) {
        memory_free(work->local[h]);
        memory_free(work->field[h]);
    }
    memory_free(work->storage);
    memory_free(work->border);
}

static bool recovery_create(const ReducedBulk *reduced, int32_t count, Recovery *work, Error *err)
{
    int64_t size = reduced->count + reduced->full_dofs;
    double *next = work->storage = memory_bytes(8 * size * count, err);
    work->border = NEW_ARRAY(double, reduced->count, err);
    for (int h = 0; h < 2; h++) {
        work->local[h] = NEW_ARRAY(double *, count, err);
        work->field[h] = NEW_ARRAY(double *, count, err);
    }
    if (!error_is_clean(err)) return false;
    for (int h = 0; h < 2; h++) {
        for (int32_t k = 0; k < count; k++) {
            work->local[h][k] = next;
            work->field[h][k] = next + reduced->half[h].count;
            next += reduced->half[h].count + reduced->half[h].full_dofs;
        }
    }
    return true;
}

static bool recover_halves(const ReducedBulk *reduced, int32_t count, const double *const *states,
                           double *const *full, Error *err)
{
    Recovery work = {0};
    TRY(recovery_create(reduced, count, &work, err));
    for (int32_t k = 0; k < count; k++)
        halves_split_motion(reduced->halves, states[k],
                            (double *const[]){work.local[0][k], work.local[1][k]}, work.border);
    for (int h = 0; h < 2; h++)
        apply_modes(&reduced->half[h], count, (const double *const *)work.local[h], work.field[h]);
    for (int32_t k = 0; k < count; k++) {
        memset(full[k], 0, (size_t)reduced->full_dofs * sizeof(double));
        for (int h = 0; h < 2; h++) fold_add(&reduced->halves->mesh[h], work.field[h][k], full[k]);
    }
cleanup:
    recovery_destroy(&work);
    return error_is_clean(err);
}

bool reduced_bulk_recover(const ReducedBulk *reduced, int32_t count, const double *const *states,
                          double *const *full, Error *err)
{
    if (reduced->half) return recover_halves(reduced, count, states, full, err);
    apply_modes(reduced, count, states, full);
    return true;
}

// Between two levels the error is not measured; it stays below the larger of theirs, or little
// above (a test asks at random: 1.2 times as large, of two materials).
static const double BETWEEN = 1.5;

double reduced_bulk_error(const ReducedBulk *reduced, double inertia)
{
    const ReductionErrors *errors = &reduced->errors;
    if (reduced->half)
        return fmax(reduced_bulk_error(&reduced->half[0], inertia),
                    reduced_bulk_error(&reduced->half[1], inertia));
    if (errors->count == 0) return 0;
    int32_t above = 0;
    while (above < errors->count - 1 && errors->inertia[above] < inertia) above++;
    double below = above > 0 ? errors->error[above - 1] : 0;
    return BETWEEN * fmax(below, errors->error[above]);
}
