// SPDX-License-Identifier: GPL-2.0-or-later
// What is far from the interface moves in few ways only: a motion of wave number k has fallen by
// exp(-k d) at a distance d. So unknowns far from it are replaced by those few motions, layer by
// layer, each twice as deep as the one before, and the reduction works on 20 rows of elements
// and a few dense blocks, whatever the block's height:
//
//     u = [ 1          ] [ u_near ]     K, C = [ sparse  K01 F1             ]
//         [   F1       ] [ a1     ]            [   .    F1'K11 F1  F1'K12 F2 ]
//         [      F2    ] [ a2     ]            [   .        .      F2'K22 F2 ]   and so on,
//
// M is diagonal: F'MF is made so. The error in S is measured at a point that the motions were not
// made at; where it is no small part of what is allowed nothing is replaced. Called by
// bulk/reduction alone.
#ifndef AMONTONS_BULK_FAR_FIELD_H
#define AMONTONS_BULK_FAR_FIELD_H

#include "bulk/far_samples.h"

enum { FAR_LAYERS_MAX = 12 };

typedef struct FarLayer {
    FarMotions motions;   // owned
    double *rotation;   // [count^2] F = motions.field * rotation; owned
    int32_t first;   // of its coordinates among the unknowns of `bulk`
} FarLayer;

typedef struct FarField {
    Bulk bulk;   // near unknowns in the mesh's order, then coordinates; owned, as what follows
    BulkOperator system;   // of `bulk`; owned
    int32_t mesh_dofs, near_count;
    int32_t *near;   // [near_count] unknowns of the mesh, ascending
    int32_t layer_count;   // 0: nothing is replaced
    FarLayer layers[FAR_LAYERS_MAX];
    double *stiffness;   // [interface_count^2] S of K/E on the mesh
    double error;   // of S, over what is allowed
} FarField;

// interface_dofs: [interface_count] unknowns of `bulk`. No error if nothing can be replaced.
bool far_field_create(const Bulk *bulk, const int32_t *interface_dofs, int32_t interface_count,
                      const FarFieldDef *def, FarField *far, Error *err);
void far_field_destroy(FarField *far);

// full [mesh_dofs * columns] from motions of `far->bulk`, [its dofs * columns].
bool far_field_expand(const FarField *far, const double *motions, int32_t columns, double *full,
                      Error *err);

#endif
