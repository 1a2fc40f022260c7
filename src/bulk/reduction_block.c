// SPDX-License-Identifier: GPL-2.0-or-later
#include "bulk/reduction_block.h"

#include "base/memory.h"

#include <math.h>

// Numbers of order 1 are rounded to this grid: far finer than an element, far coarser than
// rounding. Its steps are powers of 2, so that no length that one draws is half a step, which
// rounding could push either way.
static const double GRID = 0x1p30;

// Scenes whose numbers differ by rounding get the same. Should this fail for a node (within 1e-16
// of a half step) a basis is built twice, and both are right.
static double put_on_grid(double value)
{
    return round(value * GRID) / GRID + 0.0;   // never -0
}

void reduction_block_destroy(ReductionBlock *block)
{
    memory_free(block->position);
    bulk_destroy(&block->bulk);
    *block = (ReductionBlock){0};
}

// Assembled from the rounded positions and viscosities: M, C and K are exactly those of one block,
// in which a rigid motion has no energy. The load is the scene's nodal load over its largest,
// rounded.
bool reduction_block_create(const Mesh *mesh, const Bulk *bulk, const Material *material,
                            double load_size, ReductionBlock *block, Error *err)
{
    double length = mesh->x_max - mesh->x_min;
    double share = put_on_grid(material->eta1 / (material->eta1 + material->eta2));
    *block = (ReductionBlock){.material = *material};
    block->material.young = block->material.density = 1;
    block->material.eta1 = share;
    block->material.eta2 = 1 - share;
    block->position = NEW_ARRAY(double, 2 * (int64_t)mesh->node_count, err);
    if (!block->position) goto cleanup;
    for (int32_t i = 0; i < mesh->node_count; i++) {
        const double *at = mesh->position + 2 * (int64_t)i;
        block->position[2 * i] = put_on_grid((at[0] - mesh->x_min) / length);
        block->position[2 * i + 1] = put_on_grid(at[1] / length);
    }
    Mesh scaled = *mesh;   // borrows all but the positions
    scaled.position = block->position;
    TRY(bulk_assemble(&scaled, &block->material, &block->bulk, err));
    for (int32_t dof = 0; dof < bulk->dof_count; dof++) {
        if (bulk->held[dof]) bulk_hold(dof, &block->bulk);
        block->bulk.load[dof] = load_size > 0 ? put_on_grid(bulk->load[dof] / load_size) : 0;
    }
cleanup:
    return error_is_clean(err);
}

// All that K, C, M, f and the split into interface and interior follow from; not gmsh's node and
// element numbers, nor the names of groups.
void reduction_block_hash(const ReductionBlock *block, const Mesh *mesh, const int32_t *dofs,
                          int32_t dof_count, Hash *hash)
{
    const Bulk *bulk = &block->bulk;
    size_t unknowns = (size_t)bulk->dof_count, elements = (size_t)mesh->element_count;
    hash_number(hash, block->material.poisson);
    hash_number(hash, block->material.plane_strain);
    hash_number(hash, block->material.eta1);
    hash_bytes(hash, block->position, unknowns * sizeof *block->position);
    hash_bytes(hash, mesh->kind, elements);
    hash_bytes(hash, mesh->first_node, (elements + 1) * sizeof *mesh->first_node);
    hash_bytes(hash, mesh->element_nodes,
               (size_t)mesh->first_node[elements] * sizeof *mesh->element_nodes);
    hash_bytes(hash, bulk->load, unknowns * sizeof *bulk->load);
    hash_bytes(hash, bulk->held, unknowns);
    hash_bytes(hash, dofs, (size_t)dof_count * sizeof *dofs);
}
