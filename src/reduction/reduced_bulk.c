// SPDX-License-Identifier: GPL-2.0-or-later
#include "reduction/reduced_bulk.h"

#include "base/dense.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

void reduced_part_destroy(ReducedPart *part)
{
    memory_free(part->mass);
    memory_free(part->damping);
    memory_free(part->stiffness);
    memory_free(part->viscous);
    memory_free(part->load);
    memory_free(part->modes);
    transform_destroy(&part->border);
    transform_destroy(&part->mesh);
    *part = (ReducedPart){0};
}

void reduced_bulk_destroy(ReducedBulk *reduced)
{
    for (int p = 0; p < REDUCED_PARTS_MAX; p++) {
        ReducedPart *part = &reduced->part[p];
        if (reduced->storage)
            part->mass = part->damping = part->stiffness = part->viscous = part->load = NULL;
        reduced_part_destroy(part);
    }
    if (!reduced->storage) memory_free(reduced->load);
    memory_free(reduced->storage);
    mirrored_dofs_destroy(&reduced->at_rest);
    *reduced = (ReducedBulk){0};
}

void mirrored_dofs_destroy(MirroredDofs *mirrored)
{
    memory_free(mirrored->follow);
    memory_free(mirrored->lower);
    *mirrored = (MirroredDofs){0};
}

bool mirrored_dofs_condense(const double *border, int32_t m, int32_t count, MirroredDofs *mirrored,
                            double *schur, Error *err)
{
    int64_t n = count, all = m + n;
    mirrored->follow = NEW_ARRAY(double, n *m, err);
    mirrored->lower = NEW_ARRAY(double, n *n, err);
    if (!error_is_clean(err)) goto cleanup;
    for (int64_t j = 0; j < m; j++)
        memcpy(mirrored->follow + j * n, border + j * all + m, (size_t)n * sizeof *border);
    for (int64_t j = 0; j < n; j++)
        memcpy(mirrored->lower + j * n, border + (m + j) * all + m, (size_t)n * sizeof *border);
    if (!dense_cholesky(mirrored->lower, count))
        FAIL(err, ERROR_COMPUTE, "mirror images of the interface are not held by it");
    DenseView part = dense_view(mirrored->follow, n, m);
    dense_lower_divide(mirrored->lower, count, m, mirrored->follow);
    for (int64_t j = 0; schur && j < m; j++)
        memcpy(schur + j * m, border + j * all, (size_t)m * sizeof *schur);
    if (schur && n > 0) dense_multiply_transposed(part, part, -1, 1, schur);
    dense_lower_divide_transposed(mirrored->lower, count, m, mirrored->follow);
cleanup:
    return error_is_clean(err);
}

// --- states -------------------------------------------------------------------------------------

static DenseView follow_of(const ReducedBulk *reduced)
{
    return dense_view(reduced->at_rest.follow, reduced->mirrored, reduced->interface_count);
}

// z of the border and q of x.
static void split(const ReducedBulk *reduced, const double *border, const double *x,
                  double *const *local)
{
    const double *interior = x + reduced->interface_count + reduced->mirrored;
    for (int p = 0; p < reduced->part_count; p++) {
        transform_apply_transposed(&reduced->part[p].border, border, local[p]);
        memcpy(local[p] + reduced->part[p].border_count, interior,
               (size_t)reduced->part[p].interior_count * sizeof *interior);
        interior += reduced->part[p].interior_count;
    }
}

static void join(const ReducedBulk *reduced, const double *const *local, double *border, double *x)
{
    double *interior = x + reduced->interface_count + reduced->mirrored;
    memset(border, 0, (size_t)(reduced->interface_count + reduced->mirrored) * sizeof *border);
    for (int p = 0; p < reduced->part_count; p++) {
        transform_apply(&reduced->part[p].border, local[p], border);
        memcpy(interior, local[p] + reduced->part[p].border_count,
               (size_t)reduced->part[p].interior_count * sizeof *interior);
        interior += reduced->part[p].interior_count;
    }
    memcpy(x, border, (size_t)(reduced->interface_count + reduced->mirrored) * sizeof *x);
}

void reduced_bulk_split_motion(const ReducedBulk *reduced, const double *x, double *const *local,
                               double *border)
{
    int32_t m = reduced->interface_count, n = reduced->mirrored;
    memcpy(border, x, (size_t)(m + n) * sizeof *border);
    dense_lower_solve_transposed(reduced->at_rest.lower, n, border + m);
    dense_apply(follow_of(reduced), x, -1, 1, border + m);
    split(reduced, border, x, local);
}

void reduced_bulk_join_motion(const ReducedBulk *reduced, const double *const *local, double *x,
                              double *border)
{
    int32_t m = reduced->interface_count, n = reduced->mirrored;
    join(reduced, local, border, x);
    dense_apply(follow_of(reduced), x, 1, 1, x + m);
    dense_lower_apply_transposed(reduced->at_rest.lower, n, x + m);
}

void reduced_bulk_split_force(const ReducedBulk *reduced, const double *force, double *const *local,
                              double *border)
{
    int32_t m = reduced->interface_count, n = reduced->mirrored;
    memcpy(border, force, (size_t)(m + n) * sizeof *border);
    dense_lower_apply(reduced->at_rest.lower, n, border + m);
    dense_apply_transposed(follow_of(reduced), border + m, 1, 1, border);
    split(reduced, border, force, local);
}

void reduced_bulk_join_force(const ReducedBulk *reduced, const double *const *local, double *force,
                             double *border)
{
    int32_t m = reduced->interface_count, n = reduced->mirrored;
    join(reduced, local, border, force);
    dense_apply_transposed(follow_of(reduced), border + m, -1, 1, force);
    dense_lower_solve(reduced->at_rest.lower, n, force + m);
}

// Work of the parts of several states.
typedef struct Recovery {
    double *storage;
    double **local[REDUCED_PARTS_MAX];   // [count] each of [part's count]
    double **field[REDUCED_PARTS_MAX];   // [count] each of [part's full_dofs]
    double *border;
} Recovery;

static void recovery_destroy(Recovery *work)
{
    for (int p = 0; p < REDUCED_PARTS_MAX; p++) {
        memory_free(work->local[p]);
        memory_free(work->field[p]);
    }
    memory_free(work->storage);
    memory_free(work->border);
}

static bool recovery_create(const ReducedBulk *reduced, int32_t count, Recovery *work, Error *err)
{
    int64_t size = reduced->count + reduced->mirrored + reduced->full_dofs;
    double *next = work->storage = memory_bytes(8 * size * count, err);
    work->border = NEW_ARRAY(double, reduced->count, err);
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
        reduced_bulk_split_motion(reduced, states[k], local, work.border);
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
