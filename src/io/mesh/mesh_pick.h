// SPDX-License-Identifier: GPL-2.0-or-later
// Some regions of a mesh file without the rest: the block alone where its base was drawn, too.
// Called by model/scene_mesh.
#ifndef AMONTONS_IO_MESH_MESH_PICK_H
#define AMONTONS_IO_MESH_MESH_PICK_H

#include "io/mesh/mesh_file.h"

// Keeps the elements of the regions called `names` [count], their nodes, and of the groups what
// lies on them; a group of which nothing is left goes. ERROR_INPUT: there is no region of such a
// name.
bool mesh_file_pick(const char *path, const char (*names)[GROUP_NAME_SIZE], int32_t count,
                    MeshFile *mesh, Error *err);

#endif
