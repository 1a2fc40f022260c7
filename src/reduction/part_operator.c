// SPDX-License-Identifier: GPL-2.0-or-later
#include "reduction/part_operator.h"

#include "algebra/dense.h"
#include "base/memory.h"

#include <string.h>

// M_qq where it is tridiagonal, close together.
bool part_operator_create(const ReducedPart *part, PartOperator *system, Error *err)
{
    int64_t r = part->interior_count, stride = part->count;
    const double *mass = part->mass + part->border_count * (stride + 1);
    *system = (PartOperator){.part = part};
    for (int64_t j = 0; j < r; j++)
        for (int64_t i = j + 2; i < r; i++)
            if (mass[j * stride + i] != 0) return true;
    system->interior_mass = NEW_ARRAY(double, 2 * r, err);
    if (!system->interior_mass) return false;
    for (int64_t j = 0; j < r; j++) {
        system->interior_mass[j] = mass[j * stride + j];
        if (j + 1 < r) system->interior_mass[r + j] = mass[j * stride + j + 1];
    }
    return true;
}

void part_operator_destroy(PartOperator *system)
{
    memory_free(system->interior_mass);
    *system = (PartOperator){0};
}

void part_operator_apply(const PartOperator *system, BulkTerm term, const double *x, double *y)
{
    const ReducedPart *part = system->part;
    int32_t m = part->border_count, r = part->interior_count;
    if (term == BULK_STIFFNESS) {
        memset(y, 0, (size_t)m * sizeof(double));
        dense_add_nonzero((DenseView){part->stiffness, m, m}, x, 1, y);
        memcpy(y + m, x + m, (size_t)r * sizeof(double));
    } else if (term == BULK_MASS && system->interior_mass) {
        dense_bordered_apply((DenseBordered){.values = part->mass,
                                             .size = part->count,
                                             .border = m,
                                             .diagonal = system->interior_mass,
                                             .beside = system->interior_mass + r},
                             x, y);
    } else {
        dense_symmetric_apply(term == BULK_MASS ? part->mass : part->damping, part->count, x, y);
    }
}

// Rows `first` to `first + rows` of a column of A, but for its part in K.
static void combine_column(const ReducedPart *part, OperatorTerms terms, int64_t column,
                           int64_t first, int64_t rows, double *out)
{
    int64_t at = column * part->count + first;
    const double *mass = part->mass + at, *damping = part->damping + at;
    for (int64_t row = 0; row < rows; row++)
        out[row] = terms.mass * mass[row] + terms.damping * damping[row];
}

// The formulas at the head. The inverse itself, not a factor: a product with it is one pass over
// memory for each of many right-hand sides, and A_qq is well conditioned (K_qq = 1).
bool condensed_part_create(const ReducedPart *part, OperatorTerms terms, CondensedPart *condensed,
                           double *schur, Error *err)
{
    int64_t m = part->border_count, r = part->interior_count;
    *condensed = (CondensedPart){0};
    double *coupling = NEW_ARRAY(double, r *m, err);
    condensed->inverse = NEW_ARRAY(double, r *r, err);
    condensed->map = NEW_ARRAY(double, r *m, err);
    condensed->half = NEW_ARRAY(double, r, err);
    if (!error_is_clean(err)) goto cleanup;
    for (int64_t column = 0; column < r; column++) {
        combine_column(part, terms, m + column, m, r, condensed->inverse + column * r);
        condensed->inverse[column * r + column] += terms.stiffness;
    }
    for (int64_t column = 0; column < m; column++) {
        const double *stiffness = part->stiffness + column * m;
        combine_column(part, terms, column, m, r, coupling + column * r);
        combine_column(part, terms, column, 0, m, schur + column * m);
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
    memory_free(coupling);
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
