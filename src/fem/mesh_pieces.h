// SPDX-License-Identifier: GPL-2.0-or-later
// The connected pieces of a named boundary: a contact that is drawn as one group may be several
// pads. Called by fem/mesh_contact, and by model/contact_nodes for their names.
#ifndef AMONTONS_FEM_MESH_PIECES_H
#define AMONTONS_FEM_MESH_PIECES_H

#include "fem/mesh.h"

typedef struct MeshPieces {
    int32_t count;
    MeshBoundary
        *piece;   // [count] by their first nodes; of several "NAME/1", "NAME/2", ...; owned,
    // and what they borrow:
    char (*name)[GROUP_NAME_SIZE];   // [count]
    int32_t *nodes, *face_nodes;
} MeshPieces;

// Faces that share a node are of one piece.
bool mesh_pieces_find(const Mesh *mesh, const MeshBoundary *whole, MeshPieces *pieces, Error *err);
void mesh_pieces_destroy(MeshPieces *pieces);   // zeroed and half-built too

// True if `name` is `group` or a piece of it.
bool mesh_piece_is_of(const char *name, const char *group);

#endif
