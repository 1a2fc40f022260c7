// SPDX-License-Identifier: GPL-2.0-or-later
// The block that a basis is made of: a scene's block, its lengths over L, in units in which
// E = eta1 + eta2 = rho = 1 (their means, of several materials) and the largest nodal load is 1.
// Blocks that are geometrically similar give the same one, to the last bit, as its numbers are
// rounded. So a basis depends on its name alone, not on the length that asked for it first. Called
// by model/obtain.
#ifndef AMONTONS_REDUCTION_REDUCTION_BLOCK_H
#define AMONTONS_REDUCTION_REDUCTION_BLOCK_H

#include "base/hash.h"
#include "fem/assembly.h"

typedef struct ReductionBlock {
    double *position;   // [nodes * dim] over L, from the trailing end on; owned
    int32_t
        *image[DIM_MAX - 1];   // [nodes] at the mirror image of each across that axis; NULL: some
    // have none; owned
    Materials materials;   // normalised: means of 1; their branches are in the bulk's spectrum
    Bulk bulk;   // M / (rho L^2), C / (eta1 + eta2), K / E, f / load_size; owned
} ReductionBlock;

// bulk: of `mesh`; its load, held unknowns and spectrum are taken over. load_size: its largest
// nodal load.
bool reduction_block_create(const Mesh *mesh, const Bulk *bulk, const Materials *materials,
                            double load_size, ReductionBlock *block, Error *err);
// M, C and K of it. mesh: the same.
bool reduction_block_assemble(const Mesh *mesh, ReductionBlock *block, Error *err);
void reduction_block_destroy(ReductionBlock *block);

// Adds all that a basis of the block depends on. dofs: [dof_count] the interface.
void reduction_block_hash(const ReductionBlock *block, const Mesh *mesh, const int32_t *dofs,
                          int32_t dof_count, Hash *hash);

#endif
