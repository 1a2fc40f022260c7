// SPDX-License-Identifier: GPL-2.0-or-later
#include "reduction/reduced_part.h"

#include "base/dense.h"
#include "base/memory.h"

#include <string.h>

// M_qq where it is tridiagonal, close together.
bool reduced_part_create(const ReducedBulk *reduced, ReducedPart *part, Error *err)
{
    int64_t r = reduced->interior_count, stride = reduced->count;
    const double *mass = reduced->mass + reduced->interface_count * (stride + 1);
    *part = (ReducedPart){.reduced = reduced};
    for (int64_t j = 0; j < r; j++)
        for (int64_t i = j + 2; i < r; i++)
            if (mass[j * stride + i] != 0) return true;
    part->interior_mass = NEW_ARRAY(double, 2 * r, err);
    if (!part->interior_mass) return false;
    for (int64_t j = 0; j < r; j++) {
        part->interior_mass[j] = mass[j * stride + j];
        if (j + 1 < r) part->interior_mass[r + j] = mass[j * stride + j + 1];
    }
    return true;
}

void reduced_part_destroy(ReducedPart *part)
{
    memory_free(part->interior_mass);
    *part = (ReducedPart){0};
}

// Normalised matrices times their scale.
void reduced_part_apply(const ReducedPart *part, BulkTerm term, const double *x, double *y)
{
    const ReducedBulk *reduced = part->reduced;
    const BulkScales *scales = &reduced->scales;
    double factor = scales->stiffness;
    if (term == BULK_STIFFNESS) {
        int32_t m = reduced->interface_count;
        memset(y, 0, (size_t)m * sizeof(double));
        dense_add_nonzero((DenseView){reduced->stiffness, m, m}, x, 1, y);
        memcpy(y + m, x + m, (size_t)reduced->interior_count * sizeof(double));
    } else if (term == BULK_MASS && part->interior_mass) {
        factor = scales->mass;
        dense_bordered_apply(
            (DenseBordered){.values = reduced->mass,
                            .size = reduced->count,
                            .border = reduced->interface_count,
                            .diagonal = part->interior_mass,
                            .beside = part->interior_mass + reduced->interior_count},
            x, y);
    } else {
        factor = term == BULK_MASS ? scales->mass : scales->damping;
        dense_symmetric_apply(term == BULK_MASS ? reduced->mass : reduced->damping, reduced->count,
                              x, y);
    }
    for (int32_t k = 0; k < reduced->count; k++) y[k] *= factor;
}

// Rows `first` to `first + rows` of a column of A, but for its part in K.
static void combine_column(const ReducedBulk *reduced, OperatorTerms terms, int64_t column,
                           int64_t first, int64_t rows, double *out)
{
    int64_t at = column * reduced->count + first;
    const double *mass = reduced->mass + at, *damping = reduced->damping + at;
    double m = terms.mass * reduced->scales.mass, c = terms.damping * reduced->scales.damping;
    for (int64_t row = 0; row < rows; row++) out[row] = m * mass[row] + c * damping[row];
}

// S of C alone, where the reduction has it and nothing else will be asked for.
static bool take_viscous(const ReducedBulk *reduced, OperatorTerms terms, double *schur)
{
    if (!reduced->viscous || !terms.schur_only || terms.mass != 0 || terms.stiffness != 0)
        return false;
    double factor = terms.damping * reduced->scales.damping;
    int64_t entries = (int64_t)reduced->interface_count * reduced->interface_count;
    for (int64_t k = 0; k < entries; k++) schur[k] = factor * reduced->viscous[k];
    return true;
}

// The formulas at the head. The inverse itself, not a factor: a product with it is one pass over
// memory for each of many right-hand sides, and A_qq is well conditioned (K_qq = 1).
bool condensed_part_create(const ReducedBulk *reduced, OperatorTerms terms, CondensedPart *part,
                           double *schur, bool *taken, Error *err)
{
    int64_t m = reduced->interface_count, r = reduced->interior_count;
    double k = terms.stiffness * reduced->scales.stiffness, *coupling = NULL;
    *part = (CondensedPart){0};
    *taken = take_viscous(reduced, terms, schur);
    if (*taken) goto cleanup;
    coupling = NEW_ARRAY(double, r *m, err);
    part->inverse = NEW_ARRAY(double, r *r, err);
    part->map = NEW_ARRAY(double, r *m, err);
    part->half = NEW_ARRAY(double, r, err);
    if (!error_is_clean(err)) goto cleanup;
    for (int64_t column = 0; column < r; column++) {
        combine_column(reduced, terms, m + column, m, r, part->inverse + column * r);
        part->inverse[column * r + column] += k;
    }
    for (int64_t column = 0; column < m; column++) {
        const double *stiffness = reduced->stiffness + column * m;
        combine_column(reduced, terms, column, m, r, coupling + column * r);
        combine_column(reduced, terms, column, 0, m, schur + column * m);
        for (int64_t row = 0; row < m; row++) schur[column * m + row] += k * stiffness[row];
    }
    if (!dense_cholesky(part->inverse, (int32_t)r) ||
        !dense_invert_factored(part->inverse, (int32_t)r))
        FAIL(err, ERROR_COMPUTE, "the interior of the reduced bulk is not positive definite");
    DenseView couple = dense_view(coupling, r, m);
    dense_multiply(dense_view(part->inverse, r, r), couple, 1, 0, part->map);
    dense_multiply_transposed(couple, dense_view(part->map, r, m), -1, 1, schur);
cleanup:
    memory_free(coupling);
    return error_is_clean(err);
}

void condensed_part_destroy(CondensedPart *part)
{
    memory_free(part->inverse);
    memory_free(part->map);
    memory_free(part->half);
    *part = (CondensedPart){0};
}

void condensed_part_condense(const ReducedBulk *reduced, const CondensedPart *part,
                             const double *rhs, double *g)
{
    int32_t m = reduced->interface_count, r = reduced->interior_count;
    memcpy(g, rhs, (size_t)m * sizeof *g);
    dense_symmetric_apply(part->inverse, r, rhs + m, part->half);
    // B last: the expand reads it next.
    dense_apply_transposed((DenseView){part->map, r, m}, rhs + m, -1, 1, g);
}

void condensed_part_expand(const ReducedBulk *reduced, const CondensedPart *part,
                           const double *interface, double *v)
{
    int32_t m = reduced->interface_count, r = reduced->interior_count;
    memcpy(v, interface, (size_t)m * sizeof *v);
    memcpy(v + m, part->half, (size_t)r * sizeof *v);
    dense_add_nonzero((DenseView){part->map, r, m}, interface, -1, v + m);
}
