// SPDX-License-Identifier: GPL-2.0-or-later
#include "reduction/halves.h"

#include "base/dense.h"
#include "base/memory.h"

#include <string.h>

void halves_destroy(Halves *halves)
{
    for (int h = 0; h < 2; h++) {
        fold_destroy(&halves->border[h]);
        fold_destroy(&halves->mesh[h]);
    }
    images_destroy(&halves->at_rest);
    *halves = (Halves){0};
}

void images_destroy(FollowingImages *images)
{
    memory_free(images->follow);
    memory_free(images->lower);
    *images = (FollowingImages){0};
}

bool images_condense(const double *border, int32_t m, int32_t count, FollowingImages *images,
                     double *schur, Error *err)
{
    int64_t n = count, all = m + n;
    images->follow = NEW_ARRAY(double, n *m, err);
    images->lower = NEW_ARRAY(double, n *n, err);
    if (!error_is_clean(err)) goto cleanup;
    for (int64_t j = 0; j < m; j++)
        memcpy(images->follow + j * n, border + j * all + m, (size_t)n * sizeof *border);
    for (int64_t j = 0; j < n; j++)
        memcpy(images->lower + j * n, border + (m + j) * all + m, (size_t)n * sizeof *border);
    if (!dense_cholesky(images->lower, count))
        FAIL(err, ERROR_COMPUTE, "images of the interface are not held by it");
    DenseView half = dense_view(images->follow, n, m);
    dense_lower_divide(images->lower, count, m, images->follow);
    for (int64_t j = 0; schur && j < m; j++)
        memcpy(schur + j * m, border + j * all, (size_t)m * sizeof *schur);
    if (schur && n > 0) dense_multiply_transposed(half, half, -1, 1, schur);
    dense_lower_divide_transposed(images->lower, count, m, images->follow);
cleanup:
    return error_is_clean(err);
}

static DenseView follow_of(const Halves *halves)
{
    return dense_view(halves->at_rest.follow, halves->images, halves->interface_count);
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
    dense_lower_solve_transposed(halves->at_rest.lower, n, border + m);
    dense_apply(follow_of(halves), x, -1, 1, border + m);
    split(halves, border, x, local);
}

void halves_join_motion(const Halves *halves, const double *const local[2], double *x,
                        double *border)
{
    int32_t m = halves->interface_count, n = halves->images;
    join(halves, local, border, x);
    dense_apply(follow_of(halves), x, 1, 1, x + m);
    dense_lower_apply_transposed(halves->at_rest.lower, n, x + m);
}

void halves_split_force(const Halves *halves, const double *force, double *const local[2],
                        double *border)
{
    int32_t m = halves->interface_count, n = halves->images;
    memcpy(border, force, (size_t)(m + n) * sizeof *border);
    dense_lower_apply(halves->at_rest.lower, n, border + m);
    dense_apply_transposed(follow_of(halves), border + m, 1, 1, border);
    split(halves, border, force, local);
}

void halves_join_force(const Halves *halves, const double *const local[2], double *force,
                       double *border)
{
    int32_t m = halves->interface_count, n = halves->images;
    join(halves, local, border, force);
    dense_apply_transposed(follow_of(halves), border + m, -1, 1, force);
    dense_lower_solve(halves->at_rest.lower, n, force + m);
}
