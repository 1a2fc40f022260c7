// SPDX-License-Identifier: GPL-2.0-or-later
#include "reduction/part_operator.h"

#include "algebra/dense.h"
#include "base/memory.h"

#include <string.h>

void part_apply(const ReducedPart *part, BulkTerm term, const double *x, double *y)
{
    int32_t m = part->border_count, r = part->interior_count;
    DenseView border = {term == BULK_MASS ? part->mass : part->stiffness, m, m};
    DenseView coupling = {part->coupling, r, m};
    if (term == BULK_DAMPING) {
        dense_symmetric_apply(part->damping, part->count, x, y);
        return;
    }
    if (term >= BULK_SHAPE) {   // asked in every stage, where most of the interface is at rest
        DenseView shape = {part->shape[term - BULK_SHAPE], part->count, part->count};
        memset(y, 0, (size_t)part->count * sizeof *y);
        dense_add_nonzero(shape, x, 1, y);
        return;
    }
    memset(y, 0, (size_t)m * sizeof *y);
    dense_add_nonzero(border, x, 1, y);
    memcpy(y + m, x + m, (size_t)r * sizeof *y);
    if (term == BULK_STIFFNESS) return;
    for (int32_t k = 0; k < r; k++) y[m + k] *= part->masses[k];
    dense_add_nonzero(coupling, x, 1, y + m);
    if (r > 0) dense_apply_transposed(coupling, x + m, 1, 1, y);
}

// Adds up a column of A without its part in K; mass: NULL is 0.
static void combine_column(OperatorTerms terms, const double *mass, const double *damping,
                           int64_t rows, double *out)
{
    for (int64_t row = 0; row < rows; row++)
        out[row] = terms.mass * (mass ? mass[row] : 0) + terms.damping * damping[row];
}

// The formulas at the head. The inverse itself, not a factor: a product with it is one pass over
// memory for each of many right-hand sides, and A_qq is well conditioned (K_qq = 1).
bool condensed_part_create(const ReducedPart *part, OperatorTerms terms, const double *weight,
                           CondensedPart *condensed, double *schur, Error *err)
{
    int64_t m = part->border_count, r = part->interior_count, size = (m + r) * (m + r);
    const double *damping_values = part->damping;
    *condensed = (CondensedPart){0};
    double *coupling = NEW_ARRAY(double, r *m, err);
    double *resisting = part->shape_count > 0 ? NEW_ARRAY(double, size, err) : NULL;
    condensed->inverse = NEW_ARRAY(double, r *r, err);
    condensed->map = NEW_ARRAY(double, r *m, err);
    condensed->half = NEW_ARRAY(double, r, err);
    if (!error_is_clean(err)) goto cleanup;
    if (resisting) {   // c C + sum of the weighted shapes, in the place of C
        for (int64_t k = 0; k < size; k++) resisting[k] = terms.damping * part->damping[k];
        for (int32_t j = 0; j < part->shape_count; j++)
            for (int64_t k = 0; k < size; k++) resisting[k] += weight[j] * part->shape[j][k];
        terms.damping = 1;
        damping_values = resisting;
    }
    for (int64_t column = 0; column < r; column++) {
        const double *inside = damping_values + (m + column) * part->count + m;
        combine_column(terms, NULL, inside, r, condensed->inverse + column * r);
        condensed->inverse[column * (r + 1)] += terms.mass * part->masses[column] + terms.stiffness;
    }
    for (int64_t column = 0; column < m; column++) {
        const double *stiffness = part->stiffness + column * m;
        const double *damping = damping_values + column * part->count;
        combine_column(terms, part->coupling + column * r, damping + m, r, coupling + column * r);
        combine_column(terms, part->mass + column * m, damping, m, schur + column * m);
        for (int64_t row = 0; row < m; row++)
            schur[column * m + row] += terms.stiffness * stiffness[row];
    }
    if (!dense_cholesky(condensed->inverse, (int32_t)r) ||
        !dense_invert_factored(condensed->inverse, (int32_t)r))
        FAIL(err, ERROR_COMPUTE, "the interior of the reduced bulk is not positive definite");
    DenseView couple = dense_view(coupling, r, m);
    dense_multiply(dense_view(condensed->inverse, r, r), couple, 1, 0, condensed->map);
    dense_multiply_transposed(couple, dense_view(condensed->map, r, m), -1, 1, schur);
cleanup:
    memory_free_all(coupling, resisting);
    return error_is_clean(err);
}

void condensed_part_destroy(CondensedPart *condensed)
{
    memory_free_all(condensed->inverse, condensed->map, condensed->half);
    *condensed = (CondensedPart){0};
}

void condensed_part_condense(const ReducedPart *part, const CondensedPart *condensed,
                             const double *rhs, double *g)
{
    int32_t m = part->border_count, r = part->interior_count;
    memcpy(g, rhs, (size_t)m * sizeof *g);
    dense_symmetric_apply(condensed->inverse, r, rhs + m, condensed->half);
    // B last: the expand reads it next.
    dense_apply_transposed((DenseView){condensed->map, r, m}, rhs + m, -1, 1, g);
}

void condensed_part_expand(const ReducedPart *part, const CondensedPart *condensed,
                           const double *border, double *v)
{
    int32_t m = part->border_count, r = part->interior_count;
    memcpy(v, border, (size_t)m * sizeof *v);
    memcpy(v + m, condensed->half, (size_t)r * sizeof *v);
    dense_add_nonzero((DenseView){condensed->map, r, m}, border, -1, v + m);
}
