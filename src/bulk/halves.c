// SPDX-License-Identifier: GPL-2.0-or-later
#include "bulk/halves.h"

#include "base/dense.h"
#include "base/memory.h"

#include <string.h>

void halves_destroy(Halves *halves)
{
    for (int h = 0; h < 2; h++) {
        fold_destroy(&halves->border[h]);
        fold_destroy(&halves->mesh[h]);
    }
    memory_free(halves->follow);
    memory_free(halves->lower);
    *halves = (Halves){0};
}

bool halves_settle(Halves *halves, const double *schur, Error *err)
{
    int64_t m = halves->interface_count, n = halves->images, all = m + n;
    halves->follow = NEW_ARRAY(double, n *m, err);
    halves->lower = NEW_ARRAY(double, n *n, err);
    if (!error_is_clean(err)) goto cleanup;
    for (int64_t j = 0; j < n; j++)
        memcpy(halves->lower + j * n, schur + (m + j) * all + m, (size_t)n * sizeof(double));
    for (int64_t j = 0; j < m; j++)
        memcpy(halves->follow + j * n, schur + j * all + m, (size_t)n * sizeof(double));
    if (!dense_cholesky(halves->lower, (int32_t)n))
        FAIL(err, ERROR_COMPUTE, "the other side is not held by the interface");
    dense_lower_divide(halves->lower, (int32_t)n, (int32_t)m, halves->follow);
    dense_lower_divide_transposed(halves->lower, (int32_t)n, (int32_t)m, halves->follow);
cleanup:
    return error_is_clean(err);
}

static DenseView follow_of(const Halves *halves)
{
    return dense_view(halves->follow, halves->images, halves->interface_count);
}

// z of the border and q of x.
static void split(const Halves *halves, const double *border, const double *x,
                  double *const local[2])
{
    const double *interior = x + halves->interface_count + halves->images;
    for (int h = 0; h < 2; h++) {
        fold_take(&halves->border[h], border, local[h]);
        memcpy(local[h] + halves->border[h].count, interior,
               (size_t)halves->interior[h] * sizeof *interior);
        interior += halves->interior[h];
    }
}

static void join(const Halves *halves, const double *const local[2], double *border, double *x)
{
    double *interior = x + halves->interface_count + halves->images;
    memset(border, 0, (size_t)(halves->interface_count + halves->images) * sizeof *border);
    for (int h = 0; h < 2; h++) {
        fold_add(&halves->border[h], local[h], border);
        memcpy(interior, local[h] + halves->border[h].count,
               (size_t)halves->interior[h] * sizeof *interior);
        interior += halves->interior[h];
    }
    memcpy(x, border, (size_t)(halves->interface_count + halves->images) * sizeof *x);
}

void halves_split_motion(const Halves *halves, const double *x, double *const local[2],
                         double *border)
{
    int32_t m = halves->interface_count, n = halves->images;
    memcpy(border, x, (size_t)(m + n) * sizeof *border);
    dense_lower_solve_transposed(halves->lower, n, border + m);
    dense_apply(follow_of(halves), x, -1, 1, border + m);
    split(halves, border, x, local);
}

void halves_join_motion(const Halves *halves, const double *const local[2], double *x,
                        double *border)
{
    int32_t m = halves->interface_count, n = halves->images;
    join(halves, local, border, x);
    dense_apply(follow_of(halves), x, 1, 1, x + m);
    dense_lower_apply_transposed(halves->lower, n, x + m);
}

void halves_split_force(const Halves *halves, const double *force, double *const local[2],
                        double *border)
{
    int32_t m = halves->interface_count, n = halves->images;
    memcpy(border, force, (size_t)(m + n) * sizeof *border);
    dense_lower_apply(halves->lower, n, border + m);
    dense_apply_transposed(follow_of(halves), border + m, 1, 1, border);
    split(halves, border, force, local);
}

void halves_join_force(const Halves *halves, const double *const local[2], double *force,
                       double *border)
{
    int32_t m = halves->interface_count, n = halves->images;
    join(halves, local, border, force);
    dense_apply_transposed(follow_of(halves), border + m, -1, 1, force);
    dense_lower_solve(halves->lower, n, force + m);
}
