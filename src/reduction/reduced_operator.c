// SPDX-License-Identifier: GPL-2.0-or-later
// For each A and each part of the bulk, normalised, the inverse of its interior block and the map
//
//     B = A_qq^-1 A_qb,   S = A_bb - A_bq B,   g = rhs_b - B' rhs_q,   v_q = A_qq^-1 rhs_q - B v_b
//
// are kept. A stage reads B twice (the second time what moves of it), half of A_qq^-1 and, for M v,
// M_qb. S on the border is the sum of the parts', and mirrored unknowns R are eliminated like all
// that is inside:
//
//     E = S_RR^-1 S_Rb,   S = S_bb - S_bR E,   g = g_b - E' g_R,   u_R = S_RR^-1 g_R - E u_b.
#include "reduction/reduced_operator.h"

#include "algebra/dense.h"
#include "base/memory.h"

#include <string.h>

struct ReducedOperator {
    const ReducedBulk *reduced;   // not owned
    double *local[REDUCED_PARTS_MAX], *image[REDUCED_PARTS_MAX];   // [count] of each, work; owned
    double *border;   // [interface + mirrored] work; owned
};

void reduced_operator_destroy(ReducedOperator *system)
{
    if (!system) return;
    for (int p = 0; p < REDUCED_PARTS_MAX; p++) {
        memory_free_all(system->local[p], system->image[p]);
    }
    memory_free_all(system->border, system);
}

ReducedOperator *reduced_operator_create(const ReducedBulk *reduced, Error *err)
{
    ReducedOperator *system = NEW_ARRAY(ReducedOperator, 1, err);
    if (!system) goto cleanup;
    system->reduced = reduced;
    system->border = NEW_ARRAY(double, reduced->interface_count + reduced->mirrored, err);
    for (int p = 0; p < reduced->part_count; p++) {
        const ReducedPart *part = &reduced->part[p];
        system->local[p] = NEW_ARRAY(double, part->count, err);
        system->image[p] = NEW_ARRAY(double, part->count, err);
    }
cleanup:
    if (error_is_clean(err)) return system;
    reduced_operator_destroy(system);
    return NULL;
}

// y = K x, C x, M x or S_j x, [count] each.
static void part_apply(const ReducedPart *part, BulkTerm term, const double *x, double *y)
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

// Normalised matrices times their scale; that of shapes is in the spectrum's shares.
void reduced_operator_apply(const ReducedOperator *system, BulkTerm term, const double *x,
                            double *y)
{
    const ReducedBulk *reduced = system->reduced;
    const double scale[] = {[BULK_STIFFNESS] = reduced->scales.stiffness,
                            [BULK_DAMPING] = reduced->scales.damping,
                            [BULK_MASS] = reduced->scales.mass,
                            [BULK_SHAPE] = 1};
    const double by = scale[term < BULK_SHAPE ? term : BULK_SHAPE];
    reduced_bulk_split(reduced, x, system->local);
    for (int p = 0; p < reduced->part_count; p++)
        part_apply(&reduced->part[p], term, system->local[p], system->image[p]);
    reduced_bulk_join(reduced, (const double *const *)system->image, y);
    for (int32_t k = 0; k < reduced->count; k++) y[k] *= by;
}

void reduced_operator_keep(const ReducedOperator *system, const bool *kept, const double *x,
                           double *out)
{
    const ReducedBulk *reduced = system->reduced;
    reduced_bulk_split(reduced, x, system->local);
    for (int p = 0; p < reduced->part_count; p++)
        if (!kept[p]) memset(system->local[p], 0, (size_t)reduced->part[p].count * sizeof *x);
    reduced_bulk_join(reduced, (const double *const *)system->local, out);
}

// --- A of a part --------------------------------------------------------------------------------

typedef struct CondensedPart {
    double *inverse;   // [interior^2] A_qq^-1; owned
    double *map;   // [interior * border] B; owned
    double *half;   // [interior] A_qq^-1 rhs_q; owned
} CondensedPart;

// Adds up a column of A without its part in K; mass: NULL is 0.
static void combine_column(OperatorTerms terms, const double *mass, const double *damping,
                           int64_t rows, double *out)
{
    for (int64_t row = 0; row < rows; row++)
        out[row] = terms.mass * (mass ? mass[row] : 0) + terms.damping * damping[row];
}

// Fills schur [border^2] by the formulas at the head. weight: [shape_count] of the shape matrices
// in A. The inverse itself, not a factor: a product with it is one pass over memory for each of
// many right-hand sides, and A_qq is well conditioned (K_qq = 1).
static bool condensed_part_create(const ReducedPart *part, OperatorTerms terms,
                                  const double *weight, CondensedPart *condensed, double *schur,
                                  Error *err)
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

static void condensed_part_destroy(CondensedPart *condensed)
{
    memory_free_all(condensed->inverse, condensed->map, condensed->half);
    *condensed = (CondensedPart){0};
}

static void condensed_part_condense(const ReducedPart *part, const CondensedPart *condensed,
                                    const double *rhs, double *g)
{
    int32_t m = part->border_count, r = part->interior_count;
    memcpy(g, rhs, (size_t)m * sizeof *g);
    dense_symmetric_apply(condensed->inverse, r, rhs + m, condensed->half);
    // B last: the expand reads it next.
    dense_apply_transposed((DenseView){condensed->map, r, m}, rhs + m, -1, 1, g);
}

static void condensed_part_expand(const ReducedPart *part, const CondensedPart *condensed,
                                  const double *border, double *v)
{
    int32_t m = part->border_count, r = part->interior_count;
    memcpy(v, border, (size_t)m * sizeof *v);
    memcpy(v + m, condensed->half, (size_t)r * sizeof *v);
    dense_add_nonzero((DenseView){condensed->map, r, m}, border, -1, v + m);
}

// --- A of the bulk ------------------------------------------------------------------------------

// Mirrored unknowns condensed out of an S on the border.
typedef struct MirroredDofs {
    double *follow;   // [mirrored * interface] E; owned
    double *lower;   // [mirrored^2] Cholesky factor of S_RR; owned
} MirroredDofs;

struct CondensedBulk {
    const ReducedOperator *system;   // not owned
    CondensedPart part[REDUCED_PARTS_MAX];
    MirroredDofs mirrored;   // owned, like the rest
    double *pushed;   // [interface + mirrored] g on the border, of mirrored unknowns S_RR^-1 g_R
};

void condensed_bulk_destroy(CondensedBulk *condensed)
{
    if (!condensed) return;
    for (int p = 0; p < REDUCED_PARTS_MAX; p++) condensed_part_destroy(&condensed->part[p]);
    memory_free_all(condensed->mirrored.follow, condensed->mirrored.lower, condensed->pushed,
                    condensed);
}

// border: [m + n, squared] S; schur [m^2] := S_bb - S_bR E.
static bool condense_mirrored(const double *border, int32_t m, int32_t n, MirroredDofs *mirrored,
                              double *schur, Error *err)
{
    int64_t all = m + n;
    mirrored->follow = NEW_ARRAY(double, (int64_t)n *m, err);
    mirrored->lower = NEW_ARRAY(double, (int64_t)n *n, err);
    if (!error_is_clean(err)) return false;
    for (int64_t j = 0; j < m; j++) {
        memcpy(mirrored->follow + j * n, border + j * all + m, (size_t)n * sizeof *border);
        memcpy(schur + j * m, border + j * all, (size_t)m * sizeof *schur);
    }
    for (int64_t j = 0; j < n; j++)
        memcpy(mirrored->lower + j * n, border + (m + j) * all + m, (size_t)n * sizeof *border);
    if (!dense_cholesky(mirrored->lower, n))
        return FAULT(err, ERROR_COMPUTE, "mirror images of the interface are not held by it");
    DenseView half = dense_view(mirrored->follow, n, m);
    dense_lower_divide(mirrored->lower, n, m, mirrored->follow);
    if (n > 0) dense_multiply_transposed(half, half, -1, 1, schur);
    dense_lower_divide_transposed(mirrored->lower, n, m, mirrored->follow);
    return error_is_clean(err);
}

CondensedBulk *condensed_bulk_create(const ReducedOperator *system, OperatorTerms terms,
                                     double *schur, Error *err)
{
    const ReducedBulk *reduced = system->reduced;
    int64_t m = reduced->interface_count, size = m + reduced->mirrored, widest = 0;
    double weight[SPECTRUM_SHAPES_MAX];
    for (int p = 0; p < reduced->part_count; p++)
        if (reduced->part[p].border_count > widest) widest = reduced->part[p].border_count;
    CondensedBulk *condensed = NEW_ARRAY(CondensedBulk, 1, err);
    double *border = NEW_ARRAY(double, size *size, err);
    double *part = memory_bytes(widest * widest * (int64_t)sizeof(double), err);
    if (!error_is_clean(err)) goto cleanup;
    condensed->system = system;
    condensed->pushed = NEW_ARRAY(double, size, err);
    terms.stiffness += spectrum_weights(&reduced->spectrum, terms.damping, terms.stiffness, weight);
    terms.stiffness *= reduced->scales.stiffness;
    terms.damping *= reduced->scales.damping;
    terms.mass *= reduced->scales.mass;
    for (int p = 0; p < reduced->part_count; p++) {
        TRY(condensed_part_create(&reduced->part[p], terms, weight, &condensed->part[p], part,
                                  err));
        transform_add_square(&reduced->part[p].border, part, border);
    }
    TRY(condense_mirrored(border, (int32_t)m, reduced->mirrored, &condensed->mirrored, schur, err));
cleanup:
    memory_free_all(border, part);
    if (error_is_clean(err)) return condensed;
    condensed_bulk_destroy(condensed);
    return NULL;
}

void condensed_bulk_condense(CondensedBulk *condensed, const double *rhs, double *g)
{
    const ReducedOperator *system = condensed->system;
    const ReducedBulk *reduced = system->reduced;
    int32_t m = reduced->interface_count, n = reduced->mirrored;
    double *pushed = condensed->pushed;
    reduced_bulk_split(reduced, rhs, system->local);
    memset(pushed, 0, (size_t)(m + n) * sizeof *pushed);
    for (int p = 0; p < reduced->part_count; p++) {
        condensed_part_condense(&reduced->part[p], &condensed->part[p], system->local[p],
                                system->image[p]);
        transform_apply(&reduced->part[p].border, system->image[p], pushed);
    }
    memcpy(g, pushed, (size_t)m * sizeof *g);
    dense_apply_transposed(dense_view(condensed->mirrored.follow, n, m), pushed + m, -1, 1, g);
    dense_lower_solve(condensed->mirrored.lower, n, pushed + m);
    dense_lower_solve_transposed(condensed->mirrored.lower, n, pushed + m);
}

void condensed_bulk_expand(CondensedBulk *condensed, const double *interface, double *v)
{
    const ReducedOperator *system = condensed->system;
    const ReducedBulk *reduced = system->reduced;
    int32_t m = reduced->interface_count, n = reduced->mirrored;
    double *border = system->border;
    memcpy(border, interface, (size_t)m * sizeof *border);
    memcpy(border + m, condensed->pushed + m, (size_t)n * sizeof *border);
    dense_apply(dense_view(condensed->mirrored.follow, n, m), interface, -1, 1, border + m);
    for (int p = 0; p < reduced->part_count; p++) {
        transform_apply_transposed(&reduced->part[p].border, border, system->image[p]);
        condensed_part_expand(&reduced->part[p], &condensed->part[p], system->image[p],
                              system->local[p]);
    }
    reduced_bulk_join(reduced, (const double *const *)system->local, v);
}
