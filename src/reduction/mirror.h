// SPDX-License-Identifier: GPL-2.0-or-later
// A bulk that is its own mirror image, x -> x_0 - x, is two of half the size that know nothing of
// each other: motions that are alike on both sides (u_x opposite, u_z the same) and motions that
// are opposite. Sparse factors, products and eigenvalues of both together take a quarter to a half
// of what the whole does. Forces need not be alike on both sides.
// Called by model/obtain; reduced by reduction/symmetry_reduction.
#ifndef AMONTONS_REDUCTION_MIRROR_H
#define AMONTONS_REDUCTION_MIRROR_H

#include "reduction/transform.h"

// A pair of unknowns x, x* of the whole is (x + s x*)/sqrt(2) in a part, with s = 1 or -1; one that
// is its own image is as it is, in one of them. Both parts together are an orthogonal turn.
typedef struct MirrorPart {
    Bulk bulk;   // owned, like all below
    Transform unknowns;   // of the whole bulk
    Transform border;   // of the interface and, behind it, mirror images that are not on it
    int32_t *border_dofs;   // [border.count] unknowns of the part's bulk
} MirrorPart;

typedef struct Mirror {
    bool found;   // else all is empty
    int32_t mirrored;   // images of interface unknowns, as of rod nodes, that are not on it
    int32_t *border;   // [interface + mirrored] unknowns; owned
    MirrorPart part[2];
} Mirror;

// node_image: [nodes] (reduction/mirror_nodes). interface_dofs: [m] unknowns of `bulk`. No error if
// it is none.
bool mirror_find(const Bulk *bulk, const int32_t *node_image, const int32_t *interface_dofs,
                 int32_t m, Mirror *mirror, Error *err);
// Whether it will be found once nodes and images have been put together. position: [dof_count], x
// and z of the nodes, length.
bool mirror_is_likely(const Bulk *bulk, const double *position, const int32_t *interface_dofs,
                      int32_t m, bool *likely, Error *err);
void mirror_destroy(Mirror *mirror);   // zeroed and half-built too

#endif
