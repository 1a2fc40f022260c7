// SPDX-License-Identifier: GPL-2.0-or-later
// The bulk that is left where a FarBlock replaces what is far from the interface: unknowns that are
// near, a few rows of elements, and many small dense blocks, few of them high up. Called by
// reduction/reduction.
#ifndef AMONTONS_REDUCTION_FAR_FIELD_H
#define AMONTONS_REDUCTION_FAR_FIELD_H

#include "reduction/far_block.h"

typedef struct FarField {
    const FarBlock *block;   // not owned
    Bulk bulk;   // near unknowns in the mesh's order, then coordinates; owned, as what follows
    BulkOperator system;   // of `bulk`; owned
    int32_t mesh_dofs, near_count;
    int32_t *near;   // [near_count] unknowns of the mesh, ascending
    int32_t *first;   // [patches + 1] of a patch's coordinates among the unknowns of `bulk`
} FarField;

// mesh: the block's. unit: E.
bool far_field_create(const Bulk *mesh, const int32_t *interface_dofs, int32_t interface_count,
                      double unit, FarField *far, Error *err);
void far_field_destroy(FarField *far);

// block: that of `far`: measures what its modes leave; nothing is replaced where it is too much.
bool far_field_measure(FarField *far, FarBlock *block, Error *err);

// full [mesh_dofs * columns] from those of `far->bulk`, reduced, [its dofs * columns].
bool far_field_expand(const FarField *far, const double *reduced, int32_t columns, double *full,
                      Error *err);

#endif
