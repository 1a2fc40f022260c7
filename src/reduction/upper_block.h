// SPDX-License-Identifier: GPL-2.0-or-later
// The part of a block that designs of its contact share: all that is above a line, the lowest
// straight one along element edges from the trailing to the leading side.
//
//         +------------------------+
//         |      upper block       |
//         +----+---+----+---+----+-+   the line: its interface, with the rod's unknowns
//         |pad |   |pad |   |pad |
//         +----+   +----+   +----+
//
// Its nodes and elements are in an order of their own and its heights begin at the line, so that
// its matrices are the same to the last bit whatever is below. Called by model/obtain.
#ifndef AMONTONS_REDUCTION_UPPER_BLOCK_H
#define AMONTONS_REDUCTION_UPPER_BLOCK_H

#include "reduction/reduction_block.h"

typedef struct UpperBlock {
    ReductionBlock block;   // owned, as what follows; empty: there is no line, or all is above it
    Mesh mesh;   // without groups
    int32_t *dofs;   // [block.bulk.dof_count] its unknowns among those of the whole
    int32_t interface_count;
    int32_t *interface_dofs;   // of block.bulk: of the line, and of `dofs` of the whole above it
} UpperBlock;

// whole: of `mesh`, with the interface `dofs` [dof_count].
bool upper_block_create(const Mesh *mesh, const ReductionBlock *whole, const int32_t *dofs,
                        int32_t dof_count, UpperBlock *upper, Error *err);
void upper_block_destroy(UpperBlock *upper);

#endif
