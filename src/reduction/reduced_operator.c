// SPDX-License-Identifier: GPL-2.0-or-later
// Of two parts S on the border (reduction/symmetry_parts) is the sum of theirs, and its mirrored
// unknowns R are eliminated like all that is inside:
//
//     E = S_RR^-1 S_Rb,   S = S_bb - S_bR E,   g = g_b - E' g_R,   u_R = S_RR^-1 g_R - E u_b.
#include "reduction/reduced_operator.h"

#include "base/dense.h"
#include "base/memory.h"
#include "reduction/reduced_part.h"

#include <string.h>

struct ReducedOperator {
    const ReducedBulk *reduced;   // not owned
    ReducedPart part[2];   // one, or the two of a symmetric block
    double *local[2], *image[2];   // of two parts: [count] of each, work; owned
    double *border;   // of two parts: [interface + mirrored] work; owned
};

struct CondensedBulk {
    const ReducedOperator *system;   // not owned
    CondensedPart part[2];
    MirroredDofs mirrored;   // of two parts; owned, like the rest
    double *pushed;   // [interface + mirrored] g on the border, of mirrored unknowns S_RR^-1 g_R
};

void reduced_operator_destroy(ReducedOperator *system)
{
    if (!system) return;
    for (int p = 0; p < 2; p++) {
        reduced_part_destroy(&system->part[p]);
        memory_free(system->local[p]);
        memory_free(system->image[p]);
    }
    memory_free(system->border);
    memory_free(system);
}

ReducedOperator *reduced_operator_create(const ReducedBulk *reduced, Error *err)
{
    ReducedOperator *system = NEW_ARRAY(ReducedOperator, 1, err);
    const SymmetryParts *symmetry = reduced->symmetry;
    if (!system) goto cleanup;
    system->reduced = reduced;
    for (int p = 0; p < (symmetry ? 2 : 1); p++) {
        const ReducedBulk *part = symmetry ? &reduced->part[p] : reduced;
        TRY(reduced_part_create(part, &system->part[p], err));
        if (!symmetry) continue;
        system->local[p] = NEW_ARRAY(double, part->count, err);
        system->image[p] = NEW_ARRAY(double, part->count, err);
    }
    if (symmetry)
        system->border = NEW_ARRAY(double, symmetry->interface_count + symmetry->mirrored, err);
cleanup:
    if (error_is_clean(err)) return system;
    reduced_operator_destroy(system);
    return NULL;
}

void reduced_operator_apply(const ReducedOperator *system, BulkTerm term, const double *x,
                            double *y)
{
    const SymmetryParts *symmetry = system->reduced->symmetry;
    if (!symmetry) {
        reduced_part_apply(&system->part[0], term, x, y);
        return;
    }
    symmetry_parts_split_motion(symmetry, x, system->local, system->border);
    for (int p = 0; p < 2; p++)
        reduced_part_apply(&system->part[p], term, system->local[p], system->image[p]);
    symmetry_parts_join_force(symmetry, (const double *const *)system->image, y, system->border);
}

void condensed_bulk_destroy(CondensedBulk *condensed)
{
    if (!condensed) return;
    for (int p = 0; p < 2; p++) condensed_part_destroy(&condensed->part[p]);
    mirrored_dofs_destroy(&condensed->mirrored);
    memory_free(condensed->pushed);
    memory_free(condensed);
}

static bool condense_parts(CondensedBulk *condensed, OperatorTerms terms, double *schur,
                           bool *taken, Error *err)
{
    const ReducedBulk *reduced = condensed->system->reduced;
    const SymmetryParts *symmetry = reduced->symmetry;
    int64_t size = symmetry->interface_count + symmetry->mirrored;
    double *border = NEW_ARRAY(double, size *size, err), *part = NULL;
    if (!border) goto cleanup;
    for (int p = 0; p < 2; p++) {
        int64_t m = reduced->part[p].interface_count;
        memory_free(part);
        part = NEW_ARRAY(double, m *m, err);
        TRY(part);
        TRY(condensed_part_create(&reduced->part[p], terms, &condensed->part[p], part, taken, err));
        transform_add_square(&symmetry->border[p], part, border);
    }
    condensed->pushed = NEW_ARRAY(double, size, err);
    TRY(mirrored_dofs_condense(border, symmetry->interface_count, symmetry->mirrored,
                               &condensed->mirrored, schur, err));
cleanup:
    memory_free(border);
    memory_free(part);
    return error_is_clean(err);
}

CondensedBulk *condensed_bulk_create(const ReducedOperator *system, OperatorTerms terms,
                                     double *schur, bool *taken, Error *err)
{
    CondensedBulk *condensed = NEW_ARRAY(CondensedBulk, 1, err);
    if (!condensed) goto cleanup;
    condensed->system = system;
    if (system->reduced->symmetry)
        TRY(condense_parts(condensed, terms, schur, taken, err));
    else
        TRY(condensed_part_create(system->reduced, terms, &condensed->part[0], schur, taken, err));
cleanup:
    if (error_is_clean(err)) return condensed;
    condensed_bulk_destroy(condensed);
    return NULL;
}

void condensed_bulk_condense(CondensedBulk *condensed, const double *rhs, double *g)
{
    const ReducedOperator *system = condensed->system;
    const ReducedBulk *reduced = system->reduced;
    const SymmetryParts *symmetry = reduced->symmetry;
    if (!symmetry) {
        condensed_part_condense(reduced, &condensed->part[0], rhs, g);
        return;
    }
    int32_t m = symmetry->interface_count, n = symmetry->mirrored;
    symmetry_parts_split_force(symmetry, rhs, system->local, system->border);
    memset(condensed->pushed, 0, (size_t)(m + n) * sizeof *g);
    for (int p = 0; p < 2; p++) {
        condensed_part_condense(&reduced->part[p], &condensed->part[p], system->local[p],
                                system->image[p]);
        transform_apply(&symmetry->border[p], system->image[p], condensed->pushed);
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
    const SymmetryParts *symmetry = reduced->symmetry;
    if (!symmetry) {
        condensed_part_expand(reduced, &condensed->part[0], interface, v);
        return;
    }
    int32_t m = symmetry->interface_count, n = symmetry->mirrored;
    double *border = system->border;
    memcpy(border, interface, (size_t)m * sizeof *border);
    memcpy(border + m, condensed->pushed + m, (size_t)n * sizeof *border);
    dense_apply(dense_view(condensed->mirrored.follow, n, m), interface, -1, 1, border + m);
    for (int p = 0; p < 2; p++) {
        transform_apply_transposed(&symmetry->border[p], border, system->image[p]);
        condensed_part_expand(&reduced->part[p], &condensed->part[p], system->image[p],
                              system->local[p]);
    }
    symmetry_parts_join_motion(symmetry, (const double *const *)system->local, v, system->border);
}
