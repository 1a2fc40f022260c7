// SPDX-License-Identifier: GPL-2.0-or-later
// A bulk that is its own mirror image, x -> x_0 - x, is two of half the size that know nothing of
// each other: motions that are alike on both sides (u_x opposite, all else the same) and motions
// that are opposite; one that is its own image along two axes of the floor is four of a quarter.
// Sparse factors, products and eigenvalues of all together take a quarter to a half of what the
// whole does. Forces need not be alike on both sides.
// Called by model/obtain, reduction/reduction and reduction/reduction_block.
#ifndef AMONTONS_REDUCTION_MIRROR_H
#define AMONTONS_REDUCTION_MIRROR_H

#include "reduction/reduced_bulk.h"

// An unknown and its images are one of a part, the sum of s x over the root of their number, each s
// 1 or -1; or none where they would cancel. All parts together are an orthogonal turn.
typedef struct MirrorPart {
    Bulk bulk;   // owned, like all below
    Transform unknowns;   // of the whole bulk
    Transform border;   // of the interface and, behind it, mirror images that are not on it
    int32_t *border_dofs;   // [border.count] unknowns of the part's bulk
} MirrorPart;

typedef struct Mirror {
    int32_t part_count;   // 0: it is no image of its own, all else is empty
    int32_t mirrored;   // images of interface unknowns, as of rod nodes, that are not on it
    int32_t *border;   // [interface + mirrored] unknowns; owned
    MirrorPart part[REDUCED_PARTS_MAX];
} Mirror;

// position: [nodes * dim]. Nodes and images across `axis` that differ by 3e-9 of the length along
// it at most (three steps of reduction/reduction_block's grid; a mesher's two sides differ by less
// than one) are put in the middle, so that images are exact. *image: [nodes], of nodes in the
// middle their own; the caller's; NULL: some have none, and nothing is moved.
bool mirror_nodes_find(int32_t dim, int32_t axis, double *position, int32_t nodes, int32_t **image,
                       Error *err);

// node_image: [DIM_MAX - 1], NULL or [nodes] (mirror_nodes_find). interface_dofs: [m] unknowns
// of `bulk`. No error if it is none.
bool mirror_find(const Bulk *bulk, int32_t *const *node_image, const int32_t *interface_dofs,
                 int32_t m, Mirror *mirror, Error *err);
// *parts: how many there would be.
bool mirror_count_parts(const Bulk *bulk, int32_t *const *node_image, const int32_t *interface_dofs,
                        int32_t m, int32_t *parts, Error *err);
void mirror_destroy(Mirror *mirror);   // zeroed and half-built too

#endif
