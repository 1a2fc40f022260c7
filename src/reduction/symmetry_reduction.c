// SPDX-License-Identifier: GPL-2.0-or-later
#include "reduction/symmetry_reduction.h"

#include "base/memory.h"
#include "reduction/mirror.h"

// What of the whole follows from its parts: E and L from S of K on the border, and the load.
static bool join(ReducedBulk *reduced, Error *err)
{
    int64_t size = reduced->interface_count + reduced->mirrored;
    double *schur = NEW_ARRAY(double, size *size, err), *border = NEW_ARRAY(double, size, err);
    const double *loads[REDUCED_PARTS_MAX];
    reduced->count = (int32_t)size;
    for (int p = 0; p < reduced->part_count; p++) {
        reduced->count += reduced->part[p].interior_count;
        reduced->full_dofs += reduced->part[p].full_dofs;
        loads[p] = reduced->part[p].load;
    }
    reduced->load = NEW_ARRAY(double, reduced->count, err);
    if (!error_is_clean(err)) goto cleanup;
    for (int p = 0; p < reduced->part_count; p++)
        transform_add_square(&reduced->part[p].border, reduced->part[p].stiffness, schur);
    TRY(mirrored_dofs_condense(schur, reduced->interface_count, reduced->mirrored,
                               &reduced->at_rest, NULL, err));
    reduced_bulk_join_force(reduced, loads, reduced->load, border);
cleanup:
    memory_free(schur);
    memory_free(border);
    return error_is_clean(err);
}

bool symmetry_reduction_build(const Bulk *bulk, const int32_t *interface_dofs, int32_t m,
                              const ReductionDef *def, ReducedBulk *reduced, Error *err)
{
    Mirror mirror = {0};
    *reduced = (ReducedBulk){.interface_count = m, .part_count = 1, .scales = def->scales};
    if (def->node_image) TRY(mirror_find(bulk, def->node_image, interface_dofs, m, &mirror, err));
    if (mirror.found) {
        reduced->part_count = 2;
        reduced->mirrored = mirror.mirrored;
    } else {
        TRY(reduction_build(bulk, interface_dofs, m, def, &reduced->part[0], err));
    }
    for (int p = 0; mirror.found && p < 2; p++) {
        MirrorPart *from = &mirror.part[p];
        ReducedPart *part = &reduced->part[p];
        TRY(reduction_build(&from->bulk, from->border_dofs, from->border.count, def, part, err));
        part->border = from->border;
        from->border = (Transform){0};
        if (!def->modes) continue;
        part->mesh = from->unknowns;
        from->unknowns = (Transform){0};
    }
    TRY(join(reduced, err));
cleanup:
    mirror_destroy(&mirror);
    return error_is_clean(err);
}
