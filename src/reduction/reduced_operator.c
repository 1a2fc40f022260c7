// SPDX-License-Identifier: GPL-2.0-or-later
// S on the border is the sum of the parts', and mirrored unknowns R are eliminated like all that is
// inside:
//
//     E = S_RR^-1 S_Rb,   S = S_bb - S_bR E,   g = g_b - E' g_R,   u_R = S_RR^-1 g_R - E u_b.
#include "reduction/reduced_operator.h"

#include "base/dense.h"
#include "base/memory.h"
#include "reduction/part_operator.h"

#include <string.h>

struct ReducedOperator {
    const ReducedBulk *reduced;   // not owned
    PartOperator part[REDUCED_PARTS_MAX];
    double *local[REDUCED_PARTS_MAX], *image[REDUCED_PARTS_MAX];   // [count] of each, work; owned
    double *border;   // [interface + mirrored] work; owned
};

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
        part_operator_destroy(&system->part[p]);
        memory_free(system->local[p]);
        memory_free(system->image[p]);
    }
    memory_free(system->border);
    memory_free(system);
}

ReducedOperator *reduced_operator_create(const ReducedBulk *reduced, Error *err)
{
    ReducedOperator *system = NEW_ARRAY(ReducedOperator, 1, err);
    if (!system) goto cleanup;
    system->reduced = reduced;
    system->border = NEW_ARRAY(double, reduced->interface_count + reduced->mirrored, err);
    for (int p = 0; p < reduced->part_count; p++) {
        const ReducedPart *part = &reduced->part[p];
        TRY(part_operator_create(part, &system->part[p], err));
        system->local[p] = NEW_ARRAY(double, part->count, err);
        system->image[p] = NEW_ARRAY(double, part->count, err);
    }
cleanup:
    if (error_is_clean(err)) return system;
    reduced_operator_destroy(system);
    return NULL;
}

// Normalised matrices times their scale.
void reduced_operator_apply(const ReducedOperator *system, BulkTerm term, const double *x,
                            double *y)
{
    const ReducedBulk *reduced = system->reduced;
    const double scale[] = {[BULK_STIFFNESS] = reduced->scales.stiffness,
                            [BULK_DAMPING] = reduced->scales.damping,
                            [BULK_MASS] = reduced->scales.mass};
    reduced_bulk_split_motion(reduced, x, system->local, system->border);
    for (int p = 0; p < reduced->part_count; p++)
        part_operator_apply(&system->part[p], term, system->local[p], system->image[p]);
    reduced_bulk_join_force(reduced, (const double *const *)system->image, y, system->border);
    for (int32_t k = 0; k < reduced->count; k++) y[k] *= scale[term];
}

void condensed_bulk_destroy(CondensedBulk *condensed)
{
    if (!condensed) return;
    for (int p = 0; p < REDUCED_PARTS_MAX; p++) condensed_part_destroy(&condensed->part[p]);
    mirrored_dofs_destroy(&condensed->mirrored);
    memory_free(condensed->pushed);
    memory_free(condensed);
}

CondensedBulk *condensed_bulk_create(const ReducedOperator *system, OperatorTerms terms,
                                     double *schur, bool *taken, Error *err)
{
    const ReducedBulk *reduced = system->reduced;
    int64_t m = reduced->interface_count, size = m + reduced->mirrored;
    CondensedBulk *condensed = NEW_ARRAY(CondensedBulk, 1, err);
    double *border = NEW_ARRAY(double, size *size, err), *part = NEW_ARRAY(double, size *size, err);
    if (!error_is_clean(err)) goto cleanup;
    condensed->system = system;
    condensed->pushed = NEW_ARRAY(double, size, err);
    terms.stiffness *= reduced->scales.stiffness;
    terms.damping *= reduced->scales.damping;
    terms.mass *= reduced->scales.mass;
    for (int p = 0; p < reduced->part_count; p++) {
        TRY(condensed_part_create(&reduced->part[p], terms, &condensed->part[p], part, taken, err));
        transform_add_square(&reduced->part[p].border, part, border);
    }
    TRY(mirrored_dofs_condense(border, (int32_t)m, reduced->mirrored, &condensed->mirrored, schur,
                               err));
cleanup:
    memory_free(border);
    memory_free(part);
    if (error_is_clean(err)) return condensed;
    condensed_bulk_destroy(condensed);
    return NULL;
}

void condensed_bulk_condense(CondensedBulk *condensed, const double *rhs, double *g)
{
    const ReducedOperator *system = condensed->system;
    const ReducedBulk *reduced = system->reduced;
    int32_t m = reduced->interface_count, n = reduced->mirrored;
    reduced_bulk_split_force(reduced, rhs, system->local, system->border);
    memset(condensed->pushed, 0, (size_t)(m + n) * sizeof *g);
    for (int p = 0; p < reduced->part_count; p++) {
        condensed_part_condense(&reduced->part[p], &condensed->part[p], system->local[p],
                                system->image[p]);
        transform_apply(&reduced->part[p].border, system->image[p], condensed->pushed);
    }
    memcpy(g, condensed->pushed, (size_t)m * sizeof *g);
    dense_apply_transposed(dense_view(condensed->mirrored.follow, n, m), condensed->pushed + m, -1,
                           1, g);
    dense_lower_solve(condensed->mirrored.lower, n, condensed->pushed + m);
    dense_lower_solve_transposed(condensed->mirrored.lower, n, condensed->pushed + m);
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
    reduced_bulk_join_motion(reduced, (const double *const *)system->local, v, system->border);
}
