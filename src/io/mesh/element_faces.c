// SPDX-License-Identifier: GPL-2.0-or-later
#include "io/mesh/element_faces.h"

enum { FACES_MAX = 6 };

typedef struct FaceRow {
    int32_t count;
    ElementFace face[FACES_MAX];
} FaceRow;

// Faces of the kinds in space. The edges of plane kinds follow from their corners.
static const FaceRow ROWS[ELEMENT_KIND_COUNT] = {
    [ELEMENT_TET4] = {4,
                      {{ELEMENT_T3, {0, 2, 1}},
                       {ELEMENT_T3, {0, 1, 3}},
                       {ELEMENT_T3, {0, 3, 2}},
                       {ELEMENT_T3, {1, 2, 3}}}},
    [ELEMENT_TET10] = {4,
                       {{ELEMENT_T6, {0, 2, 1, 6, 5, 4}},
                        {ELEMENT_T6, {0, 1, 3, 4, 9, 7}},
                        {ELEMENT_T6, {0, 3, 2, 7, 8, 6}},
                        {ELEMENT_T6, {1, 2, 3, 5, 8, 9}}}},
    [ELEMENT_WEDGE6] = {5,
                        {{ELEMENT_T3, {0, 2, 1}},
                         {ELEMENT_T3, {3, 4, 5}},
                         {ELEMENT_Q4, {0, 1, 4, 3}},
                         {ELEMENT_Q4, {1, 2, 5, 4}},
                         {ELEMENT_Q4, {2, 0, 3, 5}}}},
    [ELEMENT_HEX8] = {6,
                      {{ELEMENT_Q4, {0, 3, 2, 1}},
                       {ELEMENT_Q4, {4, 5, 6, 7}},
                       {ELEMENT_Q4, {0, 1, 5, 4}},
                       {ELEMENT_Q4, {1, 2, 6, 5}},
                       {ELEMENT_Q4, {2, 3, 7, 6}},
                       {ELEMENT_Q4, {3, 0, 4, 7}}}},
    [ELEMENT_HEX27] = {6,
                       {{ELEMENT_Q9, {0, 3, 2, 1, 9, 13, 11, 8, 20}},
                        {ELEMENT_Q9, {4, 5, 6, 7, 16, 18, 19, 17, 25}},
                        {ELEMENT_Q9, {0, 1, 5, 4, 8, 12, 16, 10, 21}},
                        {ELEMENT_Q9, {1, 2, 6, 5, 11, 14, 18, 12, 23}},
                        {ELEMENT_Q9, {2, 3, 7, 6, 13, 15, 19, 14, 24}},
                        {ELEMENT_Q9, {3, 0, 4, 7, 9, 10, 17, 15, 22}}}}};

int32_t element_face_count(ElementKind kind)
{
    return element_dim(kind) == 2 ? element_corner_count(kind) : ROWS[kind].count;
}

// In the plane face k runs from corner k to the next; mid-side node k of a quadratic element, which
// follows its corners, is on it.
ElementFace element_face(ElementKind kind, int32_t face)
{
    int32_t corners = element_corner_count(kind);
    bool straight = element_node_count(kind) == corners;
    if (element_dim(kind) != 2) return ROWS[kind].face[face];
    return (ElementFace){
        straight ? ELEMENT_L2 : ELEMENT_L3,
        {(uint8_t)face, (uint8_t)((face + 1) % corners), straight ? 0 : (uint8_t)(corners + face)}};
}

int32_t element_kind_of(int32_t dim, int32_t nodes)
{
    for (int32_t kind = 0; kind < ELEMENT_KIND_COUNT; kind++)
        if (element_dim((ElementKind)kind) == dim && element_node_count((ElementKind)kind) == nodes)
            return kind;
    return -1;
}
