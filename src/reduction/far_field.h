// SPDX-License-Identifier: GPL-2.0-or-later
// Far from the interface the bulk moves in few ways only: a wave of wave number k has fallen by
// exp(-k d) at a distance d. So unknowns far from it are replaced by a few modes, patch by
// patch, the deeper the larger (reduction/far_patches):
//
//     u = T [ u_near; a1; a2; .. ],   T = [ 1           ]
//                                         [   F1        ]
//                                         [      F2     ]   and so on.
//
// The result is a small bulk: rows of elements that are near, and dense blocks, few of them high
// up. The error in S is measured at a point that the modes were not made at; where it is no small
// part of what is allowed nothing is replaced. Called by reduction/reduction.
#ifndef AMONTONS_REDUCTION_FAR_FIELD_H
#define AMONTONS_REDUCTION_FAR_FIELD_H

#include "reduction/far_samples.h"
#include "reduction/transform.h"

typedef struct FarField {
    bool used;   // false: nothing is replaced
    Transform modes;   // T; owned, as all below
    Bulk bulk;   // what is left
    BulkOperator system;   // of it
    double *stiffness;   // [interface_count^2] S of K/E of the mesh
    double slowest;   // inertia of the mesh's slowest mode; 0: it was not looked at
    double error;   // of S, over what is allowed
} FarField;

// interface_dofs: [interface_count] unknowns of `mesh`. No error if nothing can be replaced.
bool far_field_create(const Bulk *mesh, const int32_t *interface_dofs, int32_t interface_count,
                      const FarFieldDef *def, FarField *far, Error *err);
void far_field_destroy(FarField *far);

#endif
