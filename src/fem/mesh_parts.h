// SPDX-License-Identifier: GPL-2.0-or-later
// Parts of a mesh that share no node: a block and its base, or what no scene can be. Used by
// fem/mesh_build, fem/mesh_contact and run/info.
#ifndef AMONTONS_FEM_MESH_PARTS_H
#define AMONTONS_FEM_MESH_PARTS_H

#include "fem/mesh.h"

enum { PART_TEXT_SIZE = 400 };

typedef struct MeshParts {
    int32_t count;
    int32_t *part;   // [node_count] which part a node is of, from 0 in the order of nodes; owned
} MeshParts;

// The node that stands for all that are joined with node i (union-find with path halving).
// parent: [nodes], of each itself or another of those joined with it.
int32_t mesh_part_root(int32_t *parent, int32_t i);

bool mesh_parts_find(const Mesh *mesh, MeshParts *parts, Error *err);
void mesh_parts_destroy(MeshParts *parts);

// "121 nodes, x = 0 ... 1, z = 0 ... 0.5, groups 'slider', 'contact', 'top'".
const char *mesh_part_text(const Mesh *mesh, const MeshParts *parts, int32_t part,
                           char text[PART_TEXT_SIZE]);

// Text to write in a scene to have the block alone: it names the part that has most groups of a
// block.
const char *mesh_parts_advice(const Mesh *mesh, const MeshParts *parts, char text[PART_TEXT_SIZE]);

// Sets ERROR_INPUT, with the parts and the advice; returns false.
bool mesh_parts_refuse(const Mesh *mesh, const MeshParts *parts, Error *err);

// Builds as mesh_build_on_base (fem/mesh.h) does, but several parts are no error: they are in
// *parts, the caller's to destroy, and where they are no block and base nothing is known of faces
// between them. floor: NULL: no part is a base.
bool mesh_build_parts(MeshFile *file, const char *path, const char *floor, Mesh *mesh,
                      MeshParts *parts, Error *err);

#endif
