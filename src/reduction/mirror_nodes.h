// SPDX-License-Identifier: GPL-2.0-or-later
// Which node of a mesh stands at the mirror image of another. Called by reduction/reduction_block
// and reduction/mirror.
#ifndef AMONTONS_REDUCTION_MIRROR_NODES_H
#define AMONTONS_REDUCTION_MIRROR_NODES_H

#include "base/error.h"

#include <stdint.h>

// position: [nodes * dim]. Nodes and images that differ by 3e-9 of the length along x at most
// (three steps of reduction/reduction_block's grid; a mesher's two sides differ by less than one)
// are put in the middle, so that images are exact. *found: all have one; else nothing is moved.
// image: [nodes]; of nodes in the middle their own.
bool mirror_nodes_find(int32_t dim, double *position, int32_t nodes, int32_t *image, bool *found,
                       Error *err);

#endif
