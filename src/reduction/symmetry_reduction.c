// SPDX-License-Identifier: GPL-2.0-or-later
#include "reduction/symmetry_reduction.h"

#include "base/memory.h"
#include "base/parallel.h"
#include "reduction/mirror.h"

enum { TOGETHER = 2 };   // parts, for memory

typedef struct Parts {
    int first;   // of those that are built together
    Mirror *mirror;
    const ReductionDef *def;
    ReducedBulk *reduced;
} Parts;

static bool build_part(void *context, int32_t k, Error *err)
{
    Parts *parts = context;
    int p = parts->first + k;
    MirrorPart *from = &parts->mirror->part[p];
    ReducedPart *part = &parts->reduced->part[p];
    if (!reduction_build(&from->bulk, from->border_dofs, from->border.count, parts->def, part, err))
        return false;
    part->border = from->border;
    from->border = (Transform){0};
    if (!parts->def->modes) return true;
    part->mesh = from->unknowns;
    from->unknowns = (Transform){0};
    return true;
}

bool symmetry_reduction_build(const Bulk *bulk, const int32_t *interface_dofs, int32_t m,
                              const ReductionDef *def, ReducedBulk *reduced, Error *err)
{
    Mirror mirror = {0};
    Parts parts = {.mirror = &mirror, .def = def, .reduced = reduced};
    *reduced = (ReducedBulk){.dim = bulk->dim,
                             .area = bulk->area,
                             .interface_count = m,
                             .part_count = 1,
                             .scales = def->scales,
                             .spectrum = bulk->spectrum};
    if (def->node_image) TRY(mirror_find(bulk, def->node_image, interface_dofs, m, &mirror, err));
    if (mirror.part_count > 0) {
        reduced->part_count = mirror.part_count;
        reduced->mirrored = mirror.mirrored;
    } else {
        TRY(reduction_build(bulk, interface_dofs, m, def, &reduced->part[0], err));
    }
    int together = def->one_by_one ? 1 : TOGETHER;
    for (; parts.first < mirror.part_count; parts.first += together)   // 2 or 4 of them
        TRY(parallel_try(together, build_part, &parts, err));

    // Numbers of the whole that follow from its parts.
    const double *loads[REDUCED_PARTS_MAX];
    int32_t dim = bulk->dim, border_count = m + reduced->mirrored;
    reduced->count = border_count;
    for (int p = 0; p < reduced->part_count; p++) {
        reduced->count += reduced->part[p].interior_count;
        reduced->full_dofs += reduced->part[p].full_dofs;
        loads[p] = reduced->part[p].load;
    }
    TRY((reduced->load = NEW_ARRAY(double, reduced->count, err)));
    reduced_bulk_join(reduced, loads, reduced->load);
    if (!def->position) goto cleanup;

    // Rigid motions of the block as unknowns on the border, over a base that stands still; a rigid
    // motion is a static one, so that all else follows.
    const int32_t *border = mirror.border ? mirror.border : interface_dofs;
    double *next = NEW_ARRAY(double, (int64_t)rigid_count(dim) * border_count, err);
    TRY((reduced->rigid = next));
    for (int32_t which = 0; which < rigid_count(dim); which++)
        for (int32_t k = 0; k < border_count; k++) {
            const double *place = def->position + node_dof(dim, dof_node(dim, border[k]), 0);
            bool still = bulk->in_base && bulk->in_base[border[k]];
            *next++ = still ? 0 : rigid_motion(dim, which, place, dof_axis(dim, border[k]));
        }
cleanup:
    mirror_destroy(&mirror);
    return error_is_clean(err);
}
