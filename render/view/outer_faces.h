// SPDX-License-Identifier: GPL-2.0-or-later
// The faces of a mesh in space that one sees from outside. Called by surface and mesh_picture.
#ifndef AMONTONS_RENDER_VIEW_OUTER_FACES_H
#define AMONTONS_RENDER_VIEW_OUTER_FACES_H

#include "base/error.h"
#include "io/mesh/element_faces.h"

typedef struct ElementList {
    int32_t count;
    const uint8_t *kind;   // [count] ElementKind
    const int32_t *first_node;   // [count + 1] offsets into nodes
    const int32_t *nodes;   // in gmsh's order
} ElementList;

typedef struct OuterFace {
    int32_t key[FACE_CORNERS_MAX];   // its corners, ascending; -1: no more
    int32_t element, side;
} OuterFace;

// Lists the faces of one element alone: [*count], to be freed with memory_free, after a failure,
// too.
bool outer_faces(const ElementList *elements, OuterFace **faces, int32_t *count, Error *err);
// Its nodes, in the order of its kind; returns how many.
int32_t outer_face_nodes(const ElementList *elements, const OuterFace *face, ElementKind *kind,
                         int32_t nodes[FACE_NODES_MAX]);

#endif
