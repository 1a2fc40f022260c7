// SPDX-License-Identifier: GPL-2.0-or-later
// What is far from the interface moves in few ways only: a motion of wave number k has fallen by
// exp(-k d) at a distance d. So unknowns far from it are replaced by those few motions, layer by
// layer, each twice as deep as the one before:
//
//     u = [ 1          ] [ u_near ]     K, C = [ sparse  K01 F1             ]
//         [   F1       ] [ a1     ]            [   .    F1'K11 F1  F1'K12 F2 ]
//         [      F2    ] [ a2     ]            [   .        .      F2'K22 F2 ]   and so on,
//
// M is diagonal: F'MF is made so. The error in S is measured at a point that the motions were not
// made at; where it is no small part of what is allowed nothing is replaced.
//
// The bulk may be the upper block alone, its interface the line that it stands on
// (bulk/upper_block): then all this serves every design that has this block. The energy of an
// answer is the sum of that below and that above the line, so that S of the contact is off by no
// larger part than S of the line.
// Called by bulk/reduction and model/obtain; stored by model/far_cache; used by bulk/far_field.
#ifndef AMONTONS_BULK_FAR_BLOCK_H
#define AMONTONS_BULK_FAR_BLOCK_H

#include "bulk/far_samples.h"

enum { FAR_LAYERS_MAX = 12 };

// Unknowns of an interface below which factors take more of the time than the products that a far
// field saves (20 x 160 cells, 59 of them: a third slower with it; 60 x 120: an eighth faster).
enum { FAR_INTERFACE = 100 };

// Between what is near, or a layer, and the layer beyond. Pointers of both structs but `field` lead
// into the block's `indices` and `matrices`.
typedef struct FarCoupling {
    int32_t count;
    int32_t *rows;   // [count] near: unknowns of the bulk, ascending; NULL: all of the layer before
    double *stiffness, *damping;   // [count * coordinates of the layer beyond]
} FarCoupling;

typedef struct FarLayer {
    int32_t size;   // unknowns that are replaced
    int32_t *dofs;   // [size] which of the bulk, ascending
    int32_t count;   // their motions, columns of F = field * rotation, F'(K/E)F = 1
    double *field;   // [size * count]; NULL: read from a cache and not asked for; owned
    double *rotation;   // [count^2]
    double *damping;   // [count^2] F'CF
    double *mass;   // [count] F'MF, diagonal
    double *load;   // [count] F'f
    FarCoupling coupling;   // with what is before it
} FarLayer;

typedef struct FarBlock {
    int32_t dof_count;   // of the bulk
    int32_t layer_count;   // 0: nothing is replaced
    FarLayer layers[FAR_LAYERS_MAX];
    int64_t index_count, number_count;
    int32_t *indices;   // [index_count] dofs of each layer, then the rows of the first; owned
    double *matrices;   // [number_count] rotation, damping, mass, load, coupling of each; owned
    double *stiffness;   // [interface_count^2] S of K/E; NULL: read from a cache; owned
    FarSamples samples;   // what the error is measured by; owned until it is (far_field_measure)
    double error;   // of S, over what is allowed
} FarBlock;

// interface_dofs: [interface_count] unknowns of `bulk`. No error if nothing can be replaced. What
// error it leaves is not measured yet (far_field_measure).
bool far_block_create(const Bulk *bulk, const int32_t *interface_dofs, int32_t interface_count,
                      const FarFieldDef *def, FarBlock *block, Error *err);
// Makes room for all but the fields: counts and sizes of the layers and of their couplings are set.
bool far_block_lay_out(FarBlock *block, Error *err);
void far_block_destroy(FarBlock *block);

#endif
