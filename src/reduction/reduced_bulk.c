// SPDX-License-Identifier: GPL-2.0-or-later
#include "reduction/reduced_bulk.h"

#include "base/dense.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

// Those that lie in the whole's storage.
static void forget_matrices(ReducedBulk *part)
{
    part->mass = part->damping = part->stiffness = part->viscous = part->load = NULL;
}

void reduced_bulk_destroy(ReducedBulk *reduced)
{
    for (int p = 0; reduced->part && p < 2; p++) {
        if (reduced->storage) forget_matrices(&reduced->part[p]);
        reduced_bulk_destroy(&reduced->part[p]);
    }
    if (reduced->storage) forget_matrices(reduced);
    memory_free(reduced->storage);
    memory_free(reduced->mass);
    memory_free(reduced->damping);
    memory_free(reduced->stiffness);
    memory_free(reduced->viscous);
    memory_free(reduced->load);
    memory_free(reduced->modes);
    if (reduced->symmetry) symmetry_parts_destroy(reduced->symmetry);
    memory_free(reduced->symmetry);
    memory_free(reduced->part);
    *reduced = (ReducedBulk){0};
}

void reduced_bulk_set_scales(ReducedBulk *reduced, BulkScales scales)
{
    reduced->scales = scales;
    for (int p = 0; reduced->part && p < 2; p++) reduced->part[p].scales = scales;
}

bool reduced_bulk_has_modes(const ReducedBulk *reduced)
{
    return reduced->part ? reduced->part[0].modes : reduced->modes;
}

static void apply_modes(const ReducedBulk *reduced, int32_t count, const double *const *states,
                        double *const *full)
{
    DenseView modes = {reduced->modes, reduced->full_dofs, reduced->count};
    dense_apply_each(modes, count, states, full);
}

// Work of the parts of several states.
typedef struct Recovery {
    double *storage, **local[2], **field[2];   // [count] each of [part's count], [part's full_dofs]
    double *border;
} Recovery;

static void recovery_destroy(Recovery *work)
{
    for (int p = 0; p < 2; p++) {
        memory_free(work->local[p]);
        memory_free(work->field[p]);
    }
    memory_free(work->storage);
    memory_free(work->border);
}

static bool recovery_create(const ReducedBulk *reduced, int32_t count, Recovery *work, Error *err)
{
    int64_t size = reduced->count + reduced->full_dofs;
    double *next = work->storage = memory_bytes(8 * size * count, err);
    work->border = NEW_ARRAY(double, reduced->count, err);
    for (int p = 0; p < 2; p++) {
        work->local[p] = NEW_ARRAY(double *, count, err);
        work->field[p] = NEW_ARRAY(double *, count, err);
    }
    if (!error_is_clean(err)) return false;
    for (int p = 0; p < 2; p++) {
        for (int32_t k = 0; k < count; k++) {
            work->local[p][k] = next;
            work->field[p][k] = next + reduced->part[p].count;
            next += reduced->part[p].count + reduced->part[p].full_dofs;
        }
    }
    return true;
}

static bool recover_parts(const ReducedBulk *reduced, int32_t count, const double *const *states,
                          double *const *full, Error *err)
{
    Recovery work = {0};
    TRY(recovery_create(reduced, count, &work, err));
    for (int32_t k = 0; k < count; k++)
        symmetry_parts_split_motion(reduced->symmetry, states[k],
                                    (double *const[]){work.local[0][k], work.local[1][k]},
                                    work.border);
    for (int p = 0; p < 2; p++)
        apply_modes(&reduced->part[p], count, (const double *const *)work.local[p], work.field[p]);
    for (int32_t k = 0; k < count; k++) {
        memset(full[k], 0, (size_t)reduced->full_dofs * sizeof(double));
        for (int p = 0; p < 2; p++)
            transform_apply(&reduced->symmetry->mesh[p], work.field[p][k], full[k]);
    }
cleanup:
    recovery_destroy(&work);
    return error_is_clean(err);
}

bool reduced_bulk_recover(const ReducedBulk *reduced, int32_t count, const double *const *states,
                          double *const *full, Error *err)
{
    if (reduced->part) return recover_parts(reduced, count, states, full, err);
    apply_modes(reduced, count, states, full);
    return true;
}

// Between two levels the error is not measured; it stays below the larger of theirs, or little
// above (a test asks at random: 1.2 times as large, of two materials).
static const double BETWEEN = 1.5;

double reduced_bulk_error(const ReducedBulk *reduced, double inertia)
{
    const ReductionErrors *errors = &reduced->errors;
    if (reduced->part)
        return fmax(reduced_bulk_error(&reduced->part[0], inertia),
                    reduced_bulk_error(&reduced->part[1], inertia));
    if (errors->count == 0) return 0;
    int32_t above = 0;
    while (above < errors->count - 1 && errors->inertia[above] < inertia) above++;
    double below = above > 0 ? errors->error[above - 1] : 0;
    return BETWEEN * fmax(below, errors->error[above]);
}
