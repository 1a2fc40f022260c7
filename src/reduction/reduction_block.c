// SPDX-License-Identifier: GPL-2.0-or-later
#include "reduction/reduction_block.h"

#include "base/memory.h"
#include "reduction/mirror.h"

#include <math.h>

// Rounds to 30 bits: a region may be softer than the mean by any factor.
static double keep_bits(double value)
{
    int power;
    double part = frexp(value, &power);
    return ldexp(put_on_grid(part), power);
}

// E, eta1 + eta2 and rho over those of the mean.
static Materials normalise(const Materials *given)
{
    Materials made = *given;
    const Material *mean = &given->mean;
    double eta = mean->eta1 + mean->eta2;
    double share = put_on_grid(mean->eta1 / eta);
    made.mean.young = made.mean.density = 1;
    made.mean.eta1 = share;
    made.mean.eta2 = 1 - share;
    made.mean.branch_count = 0;
    made.list[0] = made.mean;
    for (int32_t k = 0; made.count > 1 && k < made.count; k++) {
        const Material *from = &given->list[k];
        made.list[k] = (Material){.young = keep_bits(from->young / mean->young),
                                  .poisson = from->poisson,
                                  .density = keep_bits(from->density / mean->density),
                                  .eta1 = keep_bits(from->eta1 / eta),
                                  .eta2 = keep_bits(from->eta2 / eta),
                                  .plane_strain = from->plane_strain};
    }
    return made;
}

void reduction_block_destroy(ReductionBlock *block)
{
    memory_free(block->position);
    for (int32_t axis = 0; axis < DIM_MAX - 1; axis++) memory_free(block->image[axis]);
    bulk_destroy(&block->bulk);
    *block = (ReductionBlock){0};
}

// Lengths by which a base is lowered while images are looked for, so that nodes of the block and of
// the base that stand at one place are told apart; a number of the grid.
static const double BASE_APART = 16;

static void raise_base(const Mesh *mesh, double height, double *position)
{
    for (int32_t i = 0; i < mesh->node_count; i++)
        if (mesh_in_base(mesh, i)) position[node_dof(mesh->dim, i, mesh->dim - 1)] += height;
}

// The load is the scene's nodal load over its largest, rounded.
bool reduction_block_create(const Mesh *mesh, const Bulk *bulk, const Materials *materials,
                            double load_size, ReductionBlock *block, Error *err)
{
    *block = (ReductionBlock){.materials = normalise(materials)};
    int64_t numbers = (int64_t)mesh->dim * mesh->node_count;
    if (!(block->position = NEW_ARRAY(double, numbers, err))) return false;
    for (int32_t i = 0; i < mesh->node_count; i++)
        for (int32_t d = 0; d < mesh->dim; d++)
            block->position[node_dof(mesh->dim, i, d)] = mesh_grid_place(mesh, i, d);
    // A mesher's two sides differ by a part of a step, and may be rounded to neighbouring ones.
    bool done = true;
    raise_base(mesh, -BASE_APART, block->position);
    for (int32_t axis = 0; done && axis < mesh->dim - 1; axis++)
        done = mirror_nodes_find(mesh->dim, axis, block->position, mesh->node_count,
                                 &block->image[axis], err);
    raise_base(mesh, BASE_APART, block->position);
    if (!done) return false;
    if (!bulk_create(mesh, &block->bulk, err)) return false;

    // The spectrum: shares over E, times over (eta1 + eta2)/E.
    const Material *mean = &materials->mean;
    Spectrum *spectrum = &block->bulk.spectrum;
    *spectrum =
        spectrum_scaled(&bulk->spectrum, 1 / mean->young, mean->young / (mean->eta1 + mean->eta2));
    for (int32_t k = 0; k < spectrum->count; k++) {
        spectrum->time[k] = keep_bits(spectrum->time[k]);
        for (int32_t j = 0; j < spectrum->shape_count; j++)
            spectrum->share[k][j] = keep_bits(spectrum->share[k][j]);
    }
    for (int32_t j = 0; j < spectrum->shape_count; j++) {
        Moduli *moduli = &spectrum->shape[j].moduli;
        moduli->deviator = keep_bits(moduli->deviator);
        moduli->trace = keep_bits(moduli->trace);
    }
    for (int32_t dof = 0; dof < bulk->dof_count; dof++) {
        block->bulk.held[dof] = bulk->held[dof];
        block->bulk.load[dof] = load_size > 0 ? put_on_grid(bulk->load[dof] / load_size) : 0;
    }
    return true;
}

// Assembles with the rounded positions and viscosities: M, C and K are exactly those of one block,
// in which a rigid motion has no energy.
bool reduction_block_assemble(const Mesh *mesh, ReductionBlock *block, Error *err)
{
    Mesh scaled = *mesh;   // borrows all but the positions
    scaled.position = block->position;
    return bulk_assemble(&scaled, block->materials.list, &block->bulk, err);
}

// All that K, C, M, f and the split into interface and interior follow from; not gmsh's node and
// element numbers, nor the names of groups.
void reduction_block_hash(const ReductionBlock *block, const Mesh *mesh, const int32_t *dofs,
                          int32_t dof_count, Hash *hash)
{
    const Bulk *bulk = &block->bulk;
    size_t unknowns = (size_t)bulk->dof_count, elements = (size_t)mesh->element_count;

    // All numbers of several materials, and where each of them is.
    const Materials *materials = &block->materials;
    hash_number(hash, materials->list[0].poisson);
    hash_number(hash, materials->list[0].plane_strain);
    hash_number(hash, materials->list[0].eta1);
    for (int32_t k = 0; materials->count > 1 && k < materials->count; k++) {
        const Material *one = &materials->list[k];
        hash_number(hash, one->young);
        hash_number(hash, one->poisson);
        hash_number(hash, one->density);
        hash_number(hash, one->eta1);
        hash_number(hash, one->eta2);
    }
    if (materials->count > 1) hash_bytes(hash, mesh->region, elements);
    spectrum_hash(&bulk->spectrum, hash);
    hash_bytes(hash, block->position, unknowns * sizeof *block->position);
    hash_bytes(hash, mesh->kind, elements);
    hash_bytes(hash, mesh->first_node, (elements + 1) * sizeof *mesh->first_node);
    hash_bytes(hash, mesh->element_nodes,
               (size_t)mesh->first_node[elements] * sizeof *mesh->element_nodes);
    if (mesh->mean_next) hash_bytes(hash, mesh->mean_next, elements * sizeof *mesh->mean_next);
    hash_bytes(hash, bulk->load, unknowns * sizeof *bulk->load);
    hash_bytes(hash, bulk->held, unknowns);
    hash_bytes(hash, dofs, (size_t)dof_count * sizeof *dofs);
    const Floor *floor = &mesh->floor;
    if (!floor->start) return;
    size_t nodes = (size_t)mesh->node_count, entries = (size_t)floor->start[mesh->node_count];
    hash_bytes(hash, mesh->is_base, nodes);
    hash_bytes(hash, floor->start, (nodes + 1) * sizeof *floor->start);
    hash_bytes(hash, floor->node, entries * sizeof *floor->node);
    hash_bytes(hash, floor->share, entries * sizeof *floor->share);
}
