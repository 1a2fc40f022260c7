// SPDX-License-Identifier: GPL-2.0-or-later
// The faces of the elements: lines in the plane; triangles and quadrilaterals in space, whose nodes
// run counter-clockwise as seen from outside. Used by io/mesh, fem/ and render.
#ifndef AMONTONS_IO_MESH_ELEMENT_FACES_H
#define AMONTONS_IO_MESH_ELEMENT_FACES_H

#include "io/mesh/mesh_file.h"

enum { FACE_NODES_MAX = 9, FACE_CORNERS_MAX = 4 };

typedef struct ElementFace {
    ElementKind kind;
    uint8_t node[FACE_NODES_MAX];   // of the element, in the order of the face's own kind
} ElementFace;

int32_t element_face_count(ElementKind kind);
ElementFace element_face(ElementKind kind, int32_t face);

// The kind of `dim` dimensions with so many nodes; -1: none of ours.
int32_t element_kind_of(int32_t dim, int32_t nodes);

#endif
