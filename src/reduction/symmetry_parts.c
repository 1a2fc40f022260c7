// SPDX-License-Identifier: GPL-2.0-or-later
#include "reduction/symmetry_parts.h"

#include "base/dense.h"
#include "base/memory.h"

#include <string.h>

void symmetry_parts_destroy(SymmetryParts *symmetry)
{
    for (int p = 0; p < 2; p++) {
        transform_destroy(&symmetry->border[p]);
        transform_destroy(&symmetry->mesh[p]);
    }
    mirrored_dofs_destroy(&symmetry->at_rest);
    *symmetry = (SymmetryParts){0};
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

static DenseView follow_of(const SymmetryParts *symmetry)
{
    return dense_view(symmetry->at_rest.follow, symmetry->mirrored, symmetry->interface_count);
}

// z of the border and q of x.
static void split(const SymmetryParts *symmetry, const double *border, const double *x,
                  double *const local[2])
{
    const double *interior = x + symmetry->interface_count + symmetry->mirrored;
    for (int p = 0; p < 2; p++) {
        transform_apply_transposed(&symmetry->border[p], border, local[p]);
        memcpy(local[p] + symmetry->border[p].count, interior,
               (size_t)symmetry->interior[p] * sizeof *interior);
        interior += symmetry->interior[p];
    }
}

static void join(const SymmetryParts *symmetry, const double *const local[2], double *border,
                 double *x)
{
    double *interior = x + symmetry->interface_count + symmetry->mirrored;
    memset(border, 0, (size_t)(symmetry->interface_count + symmetry->mirrored) * sizeof *border);
    for (int p = 0; p < 2; p++) {
        transform_apply(&symmetry->border[p], local[p], border);
        memcpy(interior, local[p] + symmetry->border[p].count,
               (size_t)symmetry->interior[p] * sizeof *interior);
        interior += symmetry->interior[p];
    }
    memcpy(x, border, (size_t)(symmetry->interface_count + symmetry->mirrored) * sizeof *x);
}

void symmetry_parts_split_motion(const SymmetryParts *symmetry, const double *x,
                                 double *const local[2], double *border)
{
    int32_t m = symmetry->interface_count, n = symmetry->mirrored;
    memcpy(border, x, (size_t)(m + n) * sizeof *border);
    dense_lower_solve_transposed(symmetry->at_rest.lower, n, border + m);
    dense_apply(follow_of(symmetry), x, -1, 1, border + m);
    split(symmetry, border, x, local);
}

void symmetry_parts_join_motion(const SymmetryParts *symmetry, const double *const local[2],
                                double *x, double *border)
{
    int32_t m = symmetry->interface_count, n = symmetry->mirrored;
    join(symmetry, local, border, x);
    dense_apply(follow_of(symmetry), x, 1, 1, x + m);
    dense_lower_apply_transposed(symmetry->at_rest.lower, n, x + m);
}

void symmetry_parts_split_force(const SymmetryParts *symmetry, const double *force,
                                double *const local[2], double *border)
{
    int32_t m = symmetry->interface_count, n = symmetry->mirrored;
    memcpy(border, force, (size_t)(m + n) * sizeof *border);
    dense_lower_apply(symmetry->at_rest.lower, n, border + m);
    dense_apply_transposed(follow_of(symmetry), border + m, 1, 1, border);
    split(symmetry, border, force, local);
}

void symmetry_parts_join_force(const SymmetryParts *symmetry, const double *const local[2],
                               double *force, double *border)
{
    int32_t m = symmetry->interface_count, n = symmetry->mirrored;
    join(symmetry, local, border, force);
    dense_apply_transposed(follow_of(symmetry), border + m, -1, 1, force);
    dense_lower_solve(symmetry->at_rest.lower, n, force + m);
}
