// SPDX-License-Identifier: GPL-2.0-or-later
// Meshes that were read before, kept on disk: the second run of a mesh loads no gmsh, which takes a
// tenth of a second whatever the mesh. Called by io/mesh/mesh_read; the hashes by study/sweep, too.
//
//     CACHE/<key>.mesh     (io/cache/cache_folder says where CACHE is)
#ifndef AMONTONS_IO_MESH_MESH_CACHE_H
#define AMONTONS_IO_MESH_MESH_CACHE_H

#include "base/archive.h"
#include "base/hash.h"
#include "io/mesh/mesh_file.h"

#include <stdbool.h>

// The bytes of `path` and the values of `parameters` into *hash. *whole: the mesh is made of these
// alone; a .geo may include and merge other files, ask for variables of the environment, look into
// folders, run commands. ERROR_INPUT: it cannot be read.
bool mesh_source_hash(const char *path, const MeshParameter *parameters, int32_t parameter_count,
                      Hash *hash, bool *whole, Error *err);

// Hashes the mesh that was made: nodes, elements, groups.
void mesh_file_hash(const MeshFile *mesh, Hash *hash);

// The key of what `path` and `parameters` make; empty where that is not known before meshing (not
// whole).
bool mesh_cache_key(const char *path, const MeshParameter *parameters, int32_t parameter_count,
                    char key[HASH_TEXT_SIZE], Error *err);

// Fills `mesh`. *found: false where there is nothing, or nothing that is valid.
bool mesh_cache_load(const char *key, MeshFile *mesh, bool *found, Error *err);

// A MeshFile, as the cache has it.
void mesh_archive(void *mesh, Archive *archive);

// Never an error: what cannot be stored is read by gmsh again.
void mesh_cache_store(const char *key, const MeshFile *mesh);

#endif
