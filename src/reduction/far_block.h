// SPDX-License-Identifier: GPL-2.0-or-later
// What is far from the interface moves in few ways only: a wave of wave number k has fallen by
// exp(-k d) at a distance d. So unknowns far from it are replaced by a few modes, patch by
// patch, the deeper the larger (reduction/far_patches):
//
//     u = [ 1          ] [ u_near ]     K, C = [ sparse  K01 F1     K02 F2    ]
//         [   F1       ] [ a1     ]            [   .    F1'K11 F1  F1'K12 F2 ]
//         [      F2    ] [ a2     ]            [   .        .      F2'K22 F2 ]   and so on,
//
// with blocks beside the diagonal where two patches touch. M is diagonal: F'MF is made so. The
// error in S is measured at a point that the modes were not made at; where it is no small part of
// what is allowed nothing is replaced.
// Called by reduction/reduction; used by reduction/far_field.
#ifndef AMONTONS_REDUCTION_FAR_BLOCK_H
#define AMONTONS_REDUCTION_FAR_BLOCK_H

#include "reduction/far_samples.h"

// Of a patch with what is near or with a patch before it. Pointers of both structs lead into
// the block's `indices` and `numbers`.
typedef struct FarCoupling {
    int32_t patch, before;   // the columns'; the rows': NO_PATCH
    int32_t count;   // rows: of near unknowns those that touch it, of a patch all coordinates
    int32_t *rows;   // [count] near: unknowns of the bulk, ascending; else NULL
    double *stiffness, *damping;   // [count * coordinates of the patch]
} FarCoupling;

typedef struct FarPatch {
    int32_t size;   // unknowns that are replaced
    int32_t *dofs;   // [size] which of the bulk, ascending
    int32_t count;   // their modes, columns of F = field * rotation, F'(K/E)F = 1
    double *field;   // [size * count]
    double *rotation;   // [count^2]
    double *damping;   // [count^2] F'CF
    double *mass;   // [count] F'MF, diagonal
    double *load;   // [count] F'f
} FarPatch;

typedef struct FarBlock {
    int32_t patch_count;   // 0: nothing is replaced
    FarPatch *patches;   // [patch_count] owned, as all below
    int32_t coupling_count;
    FarCoupling *couplings;   // [coupling_count] by patch, then by what is before
    int32_t *indices;
    double *numbers;
    double *stiffness;   // [interface_count^2] S of K/E
    FarSamples samples;   // what the error is measured by; until it is (far_field_measure)
    double error;   // of S, over what is allowed
} FarBlock;

// interface_dofs: [interface_count] unknowns of `bulk`. No error if nothing can be replaced. What
// error it leaves is not measured yet (far_field_measure).
bool far_block_create(const Bulk *bulk, const int32_t *interface_dofs, int32_t interface_count,
                      const FarFieldDef *def, FarBlock *block, Error *err);
void far_block_destroy(FarBlock *block);

#endif
