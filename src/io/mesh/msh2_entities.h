// SPDX-License-Identifier: GPL-2.0-or-later
// Format 2.x gives each element its physical group and its elementary entity; gmsh keeps the group
// of an entity only. Where one entity's number stands on elements of different groups (other
// programs than gmsh number entities as they like, meshio writes 0 for all of them), gmsh would
// give each group the elements of all. Called by io/mesh/mesh_read.
#ifndef AMONTONS_IO_MESH_MSH2_ENTITIES_H
#define AMONTONS_IO_MESH_MSH2_ENTITIES_H

#include "base/error.h"

#include <stdint.h>

// Numbers the entities of a file of format 2.x so that all elements of one are in the same groups.
// bytes: [size + 1], zero-terminated. *mended ([*mended_size], the caller's to free) is the file
// with the new numbers; NULL where those of the file will do, or where it is not understood: then
// gmsh says what is wrong with it.
bool msh2_tell_entities_apart(const char *bytes, int64_t size, char **mended, int64_t *mended_size,
                              Error *err);

#endif
