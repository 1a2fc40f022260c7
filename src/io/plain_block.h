// SPDX-License-Identifier: GPL-2.0-or-later
// The block that meshes/block.geo makes of even quadrilaterals, without gmsh, which takes a tenth
// of a second to load: nodes, elements, groups and their numbers are those of gmsh 4.8, to the bit.
// Called by io/mesh_read.
#ifndef AMONTONS_IO_PLAIN_BLOCK_H
#define AMONTONS_IO_PLAIN_BLOCK_H

#include "io/mesh_file.h"

#include <stdbool.h>

// *made: false where `path` has not the bytes of meshes/block.geo, or where `parameters` ask for
// more than sizes and numbers of cells, or for what cannot be: that is gmsh's.
bool plain_block_make(const char *path, const MeshParameter *parameters, int32_t parameter_count,
                      MeshFile *mesh, bool *made, Error *err);

#endif
