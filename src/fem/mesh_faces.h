// SPDX-License-Identifier: GPL-2.0-or-later
// The faces of a mesh's elements (in the plane its edges), each once, with the number of elements
// it is on: 1 on the block's boundary, 2 inside. Used by fem/mesh to check elements, named
// boundaries and contact.
#ifndef AMONTONS_FEM_MESH_FACES_H
#define AMONTONS_FEM_MESH_FACES_H

#include "fem/mesh.h"
#include "io/mesh/element_faces.h"

#include <stdint.h>

// One face: its nodes [element_node_count(kind)], in the kind's order. Borrows.
typedef struct FaceNodes {
    ElementKind kind;
    const int32_t *node;
} FaceNodes;

// Face `side` of element e; nodes: [FACE_NODES_MAX] room for them.
FaceNodes mesh_element_face(const Mesh *mesh, int32_t e, int32_t side, int32_t *nodes);

FaceNodes mesh_boundary_face(const MeshBoundary *boundary, int32_t face);

enum { FACE_INNER_MAX = FACE_NODES_MAX - FACE_CORNERS_MAX };

// A face by its nodes, whatever their order: ascending, -1 where there are fewer.
typedef struct FaceKey {
    int32_t corner[FACE_CORNERS_MAX];   // the lowest is the bucket
    int32_t inner[FACE_INNER_MAX];   // mid-side nodes and centre
} FaceKey;

typedef struct MeshFace {
    FaceKey key;
    int32_t elements;   // on how many elements
    int32_t element, side;   // one of them, and which of its faces
} MeshFace;

// Faces in buckets by their lowest corner: those of node i are faces[first[i] .. last[i] - 1].
typedef struct MeshFaces {
    int32_t *first;   // [node_count + 1]; owned
    int32_t *last;   // [node_count]; owned
    MeshFace *faces;   // [first[node_count]]; owned
} MeshFaces;

// ERROR_INPUT where a face is on three elements or has different nodes between its corners.
bool mesh_faces_build(const Mesh *mesh, MeshFaces *table, Error *err);
void mesh_faces_destroy(MeshFaces *table);

// The face with the same corners, NULL: none.
const MeshFace *mesh_faces_find(const MeshFaces *table, FaceNodes face);
// It has the same nodes between them, too.
bool mesh_face_is(const MeshFace *known, FaceNodes face);

#endif
