// SPDX-License-Identifier: GPL-2.0-or-later
// Hashes the source of a mesh, the bytes of its file, and finds whether the mesh depends on these
// alone. A .geo may include and merge other files, ask for variables of the environment, look into
// folders, run commands. Called by io/mesh/mesh_cache and study/sweep for their keys.
#ifndef AMONTONS_IO_MESH_MESH_SOURCE_H
#define AMONTONS_IO_MESH_MESH_SOURCE_H

#include "base/hash.h"
#include "io/mesh/mesh_file.h"

#include <stdbool.h>

// The bytes of `path` and the values of `parameters` into *hash. *whole: the mesh is made of these
// alone. ERROR_INPUT: it cannot be read.
bool mesh_source_hash(const char *path, const MeshParameter *parameters, int32_t parameter_count,
                      Hash *hash, bool *whole, Error *err);

// Hashes the mesh that was made: nodes, elements, groups.
void mesh_file_hash(const MeshFile *mesh, Hash *hash);

#endif
