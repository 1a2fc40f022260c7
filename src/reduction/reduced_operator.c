// SPDX-License-Identifier: GPL-2.0-or-later
// Of two halves S on the border (reduction/halves) is the sum of theirs, and its images R are
// eliminated like all that is inside:
//
//     E = S_RR^-1 S_Rb,   S = S_bb - S_bR E,   g = g_b - E' g_R,   u_R = S_RR^-1 g_R - E u_b.
#include "reduction/reduced_operator.h"

#include "base/dense.h"
#include "base/memory.h"
#include "reduction/reduced_part.h"

#include <string.h>

struct ReducedOperator {
    const ReducedBulk *reduced;   // not owned
    ReducedPart part[2];   // one, or two halves
    double *local[2], *image[2];   // of halves: [count] of each, work; owned
    double *border;   // of halves: [interface and images] work; owned
};

struct CondensedBulk {
    const ReducedOperator *system;   // not owned
    CondensedPart part[2];
    FollowingImages images;   // of halves; owned, like the rest
    double *pushed;   // [interface + images] g on the border, of images S_RR^-1 g_R
};

void reduced_operator_destroy(ReducedOperator *system)
{
    if (!system) return;
    for (int h = 0; h < 2; h++) {
        reduced_part_destroy(&system->part[h]);
        memory_free(system->local[h]);
        memory_free(system->image[h]);
    }
    memory_free(system->border);
    memory_free(system);
}

ReducedOperator *reduced_operator_create(const ReducedBulk *reduced, Error *err)
{
    ReducedOperator *system = NEW_ARRAY(ReducedOperator, 1, err);
    const Halves *halves = reduced->halves;
    if (!system) goto cleanup;
    system->reduced = reduced;
    for (int h = 0; h < (halves ? 2 : 1); h++) {
        const ReducedBulk *part = halves ? &reduced->half[h] : reduced;
        TRY(reduced_part_create(part, &system->part[h], err));
        if (!halves) continue;
        system->local[h] = NEW_ARRAY(double, part->count, err);
        system->image[h] = NEW_ARRAY(double, part->count, err);
    }
    if (halves) system->border = NEW_ARRAY(double, halves->interface_count + halves->images, err);
cleanup:
    if (error_is_clean(err)) return system;
    reduced_operator_destroy(system);
    return NULL;
}

void reduced_operator_apply(const ReducedOperator *system, BulkTerm term, const double *x,
                            double *y)
{
    const Halves *halves = system->reduced->halves;
    if (!halves) {
        reduced_part_apply(&system->part[0], term, x, y);
        return;
    }
    halves_split_motion(halves, x, system->local, system->border);
    for (int h = 0; h < 2; h++)
        reduced_part_apply(&system->part[h], term, system->local[h], system->image[h]);
    halves_join_force(halves, (const double *const *)system->image, y, system->border);
}

void condensed_bulk_destroy(CondensedBulk *condensed)
{
    if (!condensed) return;
    for (int h = 0; h < 2; h++) condensed_part_destroy(&condensed->part[h]);
    images_destroy(&condensed->images);
    memory_free(condensed->pushed);
    memory_free(condensed);
}

static bool condense_halves(CondensedBulk *condensed, OperatorTerms terms, double *schur,
                            bool *taken, Error *err)
{
    const ReducedBulk *reduced = condensed->system->reduced;
    const Halves *halves = reduced->halves;
    int64_t size = halves->interface_count + halves->images;
    double *border = NEW_ARRAY(double, size *size, err), *half = NULL;
    if (!border) goto cleanup;
    for (int h = 0; h < 2; h++) {
        int64_t m = reduced->half[h].interface_count;
        memory_free(half);
        half = NEW_ARRAY(double, m *m, err);
        TRY(half);
        TRY(condensed_part_create(&reduced->half[h], terms, &condensed->part[h], half, taken, err));
        fold_add_square(&halves->border[h], half, (int32_t)size, border);
    }
    condensed->pushed = NEW_ARRAY(double, size, err);
    TRY(images_condense(border, halves->interface_count, halves->images, &condensed->images, schur,
                        err));
cleanup:
    memory_free(border);
    memory_free(half);
    return error_is_clean(err);
}

CondensedBulk *condensed_bulk_create(const ReducedOperator *system, OperatorTerms terms,
                                     double *schur, bool *taken, Error *err)
{
    CondensedBulk *condensed = NEW_ARRAY(CondensedBulk, 1, err);
    if (!condensed) goto cleanup;
    condensed->system = system;
    if (system->reduced->halves)
        TRY(condense_halves(condensed, terms, schur, taken, err));
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
    const Halves *halves = reduced->halves;
    if (!halves) {
        condensed_part_condense(reduced, &condensed->part[0], rhs, g);
        return;
    }
    int32_t m = halves->interface_count, n = halves->images;
    halves_split_force(halves, rhs, system->local, system->border);
    memset(condensed->pushed, 0, (size_t)(m + n) * sizeof *g);
    for (int h = 0; h < 2; h++) {
        condensed_part_condense(&reduced->half[h], &condensed->part[h], system->local[h],
                                system->image[h]);
        fold_add(&halves->border[h], system->image[h], condensed->pushed);
    }
    memcpy(g, condensed->pushed, (size_t)m * sizeof *g);
    dense_apply_transposed(dense_view(condensed->images.follow, n, m), condensed->pushed + m, -1, 1,
                           g);
    dense_lower_solve(condensed->images.lower, n, condensed->pushed + m);
    dense_lower_solve_transposed(condensed->images.lower, n, condensed->pushed + m);
}

void condensed_bulk_expand(CondensedBulk *condensed, const double *interface, double *v)
{
    const ReducedOperator *system = condensed->system;
    const ReducedBulk *reduced = system->reduced;
    const Halves *halves = reduced->halves;
    if (!halves) {
        condensed_part_expand(reduced, &condensed->part[0], interface, v);
        return;
    }
    int32_t m = halves->interface_count, n = halves->images;
    double *border = system->border;
    memcpy(border, interface, (size_t)m * sizeof *border);
    memcpy(border + m, condensed->pushed + m, (size_t)n * sizeof *border);
    dense_apply(dense_view(condensed->images.follow, n, m), interface, -1, 1, border + m);
    for (int h = 0; h < 2; h++) {
        fold_take(&halves->border[h], border, system->image[h]);
        condensed_part_expand(&reduced->half[h], &condensed->part[h], system->image[h],
                              system->local[h]);
    }
    halves_join_motion(halves, (const double *const *)system->local, v, system->border);
}
