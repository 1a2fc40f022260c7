// SPDX-License-Identifier: GPL-2.0-or-later
// S on the border is the sum of the parts', and mirrored unknowns R are eliminated like all that is
// inside:
//
//     E = S_RR^-1 S_Rb,   S = S_bb - S_bR E,   g = g_b - E' g_R,   u_R = S_RR^-1 g_R - E u_b.
#include "reduction/reduced_operator.h"

#include "algebra/dense.h"
#include "base/memory.h"
#include "reduction/part_operator.h"

#include <string.h>

struct ReducedOperator {
    const ReducedBulk *reduced;   // not owned
    double *local[REDUCED_PARTS_MAX], *image[REDUCED_PARTS_MAX];   // [count] of each, work; owned
    double *border;   // [interface + mirrored] work; owned
};

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
