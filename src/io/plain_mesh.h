// SPDX-License-Identifier: GPL-2.0-or-later
// Meshes in rows of quadrilaterals that meshes/block.geo and meshes/pads.geo ask for, without gmsh,
// which takes a tenth of a second to load: nodes, elements, groups and their numbers are those of
// gmsh 4.8, to the bit. Called by io/mesh_read.
#ifndef AMONTONS_IO_PLAIN_MESH_H
#define AMONTONS_IO_PLAIN_MESH_H

#include "io/plain_model.h"

#include <stdbool.h>

// *made: false where `path` has not the bytes of a file that is known, or where `parameters` ask
// for anything but rows of quadrilaterals of order 1, or for what cannot be: that is gmsh's.
bool plain_mesh_make(const char *path, const MeshParameter *parameters, int32_t parameter_count,
                     MeshFile *mesh, bool *made, Error *err);

// One file's: *model is what the parameters ask for, to be destroyed by the caller; *fits: false
// for what is left to gmsh.
bool plain_block_build(const MeshParameter *given, int32_t count, PlainModel *model, bool *fits,
                       Error *err);
bool plain_pads_build(const MeshParameter *given, int32_t count, PlainModel *model, bool *fits,
                      Error *err);

#endif
