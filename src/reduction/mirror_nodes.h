// SPDX-License-Identifier: GPL-2.0-or-later
// Which node of a mesh stands at the mirror image of another. Called by reduction/reduction_block
// and reduction/mirror.
#ifndef AMONTONS_REDUCTION_MIRROR_NODES_H
#define AMONTONS_REDUCTION_MIRROR_NODES_H

#include "base/error.h"

#include <stdint.h>

// position: [nodes * dim]. Nodes and images across `axis` that differ by 3e-9 of the length along
// it at most (three steps of reduction/reduction_block's grid; a mesher's two sides differ by less
// than one) are put in the middle, so that images are exact. *image: [nodes], of nodes in the
// middle their own; the caller's; NULL: some have none, and nothing is moved.
bool mirror_nodes_find(int32_t dim, int32_t axis, double *position, int32_t nodes, int32_t **image,
                       Error *err);

#endif
