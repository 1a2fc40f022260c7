// SPDX-License-Identifier: GPL-2.0-or-later
#include "reduction/symmetry_reduction.h"

#include "base/memory.h"

// E and L from S of K on the border.
static bool settle(SymmetryParts *symmetry, const ReducedBulk *part, Error *err)
{
    int64_t size = symmetry->interface_count + symmetry->mirrored;
    double *schur = NEW_ARRAY(double, size *size, err);
    if (!schur) return false;
    for (int p = 0; p < 2; p++)
        transform_add_square(&symmetry->border[p], part[p].stiffness, schur);
    bool done = mirrored_dofs_condense(schur, symmetry->interface_count, symmetry->mirrored,
                                       &symmetry->at_rest, NULL, err);
    memory_free(schur);
    return done;
}

static bool join_loads(ReducedBulk *reduced, Error *err)
{
    const ReducedBulk *part = reduced->part;
    const double *const loads[] = {part[0].load, part[1].load};
    double *border = NEW_ARRAY(double, reduced->count, err);
    reduced->load = NEW_ARRAY(double, reduced->count, err);
    if (border && reduced->load)
        symmetry_parts_join_force(reduced->symmetry, loads, reduced->load, border);
    memory_free(border);
    return error_is_clean(err);
}

bool symmetry_reduction_build(Mirror *mirror, int32_t m, const ReductionDef *def,
                              ReducedBulk *reduced, Error *err)
{
    *reduced = (ReducedBulk){.interface_count = m,
                             .interior_count = mirror->mirrored,
                             .scales = def->scales,
                             .part = NEW_ARRAY(ReducedBulk, 2, err),
                             .symmetry = NEW_ARRAY(SymmetryParts, 1, err)};
    SymmetryParts *symmetry = reduced->symmetry;
    if (!error_is_clean(err)) goto cleanup;
    *symmetry = (SymmetryParts){.interface_count = m, .mirrored = mirror->mirrored};
    for (int p = 0; p < 2; p++) {
        MirrorPart *from = &mirror->part[p];
        TRY(reduction_build(&from->bulk, from->border_dofs, from->border.count, def,
                            &reduced->part[p], err));
        symmetry->interior[p] = reduced->part[p].interior_count;
        symmetry->border[p] = from->border;
        from->border = (Transform){0};
        reduced->interior_count += symmetry->interior[p];
        reduced->full_dofs += from->bulk.dof_count;
        if (!def->modes) continue;
        symmetry->mesh[p] = from->unknowns;
        from->unknowns = (Transform){0};
    }
    reduced->count = m + reduced->interior_count;
    TRY(settle(symmetry, reduced->part, err));
    TRY(join_loads(reduced, err));
cleanup:
    return error_is_clean(err);
}
