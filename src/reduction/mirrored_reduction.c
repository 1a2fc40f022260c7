// SPDX-License-Identifier: GPL-2.0-or-later
#include "reduction/mirrored_reduction.h"

#include "base/memory.h"

// E and L from S of K on the border.
static bool settle(Halves *halves, const ReducedBulk *half, Error *err)
{
    int64_t size = halves->interface_count + halves->images;
    double *schur = NEW_ARRAY(double, size *size, err);
    if (!schur) return false;
    for (int h = 0; h < 2; h++)
        fold_add_square(&halves->border[h], half[h].stiffness, (int32_t)size, schur);
    bool done = images_condense(schur, halves->interface_count, halves->images, &halves->at_rest,
                                NULL, err);
    memory_free(schur);
    return done;
}

static bool join_loads(ReducedBulk *reduced, Error *err)
{
    const ReducedBulk *half = reduced->half;
    const double *const loads[] = {half[0].load, half[1].load};
    double *border = NEW_ARRAY(double, reduced->count, err);
    reduced->load = NEW_ARRAY(double, reduced->count, err);
    if (border && reduced->load) halves_join_force(reduced->halves, loads, reduced->load, border);
    memory_free(border);
    return error_is_clean(err);
}

bool mirrored_reduction_build(Mirror *mirror, int32_t m, const ReductionDef *def,
                              ReducedBulk *reduced, Error *err)
{
    *reduced = (ReducedBulk){.interface_count = m,
                             .interior_count = mirror->images,
                             .scales = def->scales,
                             .half = NEW_ARRAY(ReducedBulk, 2, err),
                             .halves = NEW_ARRAY(Halves, 1, err)};
    Halves *halves = reduced->halves;
    if (!error_is_clean(err)) goto cleanup;
    *halves = (Halves){.interface_count = m, .images = mirror->images};
    for (int h = 0; h < 2; h++) {
        MirrorHalf *from = &mirror->half[h];
        TRY(reduction_build(&from->bulk, from->border_dofs, from->border.count, def,
                            &reduced->half[h], err));
        halves->interior[h] = reduced->half[h].interior_count;
        halves->border[h] = from->border;
        from->border = (Fold){0};
        reduced->interior_count += halves->interior[h];
        reduced->full_dofs += from->bulk.dof_count;
        if (!def->modes) continue;
        halves->mesh[h] = from->unknowns;
        from->unknowns = (Fold){0};
    }
    reduced->count = m + reduced->interior_count;
    TRY(settle(halves, reduced->half, err));
    TRY(join_loads(reduced, err));
cleanup:
    return error_is_clean(err);
}
