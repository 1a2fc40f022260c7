// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/view/outer_faces.h"

#include "base/memory.h"
#include "base/order.h"

#include <stdlib.h>
#include <string.h>

static int compare_faces(const void *left, const void *right)
{
    return memcmp(left, right, sizeof(int32_t[FACE_CORNERS_MAX]));
}

int32_t outer_face_nodes(const ElementList *elements, const OuterFace *face, ElementKind *kind,
                         int32_t nodes[FACE_NODES_MAX])
{
    ElementFace own = element_face((ElementKind)elements->kind[face->element], face->side);
    int32_t count = element_node_count(own.kind);
    for (int32_t a = 0; a < count; ++a)
        nodes[a] = elements->nodes[elements->first_node[face->element] + own.node[a]];
    *kind = own.kind;
    return count;
}

bool outer_faces(const ElementList *elements, OuterFace **faces, int32_t *count, Error *err)
{
    int64_t all = 0;
    int32_t listed = 0;
    *count = 0;
    for (int32_t e = 0; e < elements->count; ++e)
        all += element_face_count((ElementKind)elements->kind[e]);
    OuterFace *list = *faces = NEW_ARRAY(OuterFace, all, err);
    if (!list) return false;
    for (int32_t e = 0; e < elements->count; ++e)
        for (int32_t side = 0; side < element_face_count((ElementKind)elements->kind[e]); ++side) {
            OuterFace *face = &list[listed++];
            int32_t nodes[FACE_NODES_MAX];
            ElementKind kind;
            *face = (OuterFace){{-1, -1, -1, -1}, e, side};
            outer_face_nodes(elements, face, &kind, nodes);
            memcpy(face->key, nodes, (size_t)element_corner_count(kind) * sizeof *nodes);
            qsort(face->key, (size_t)element_corner_count(kind), sizeof *nodes, order_int32);
        }

    // Sorted, those of two elements stand side by side.
    qsort(list, (size_t)listed, sizeof *list, compare_faces);
    for (int32_t k = 0; k < listed; ++k) {
        if (k > 0 && compare_faces(&list[k - 1], &list[k]) == 0) continue;   // its twin was met
        if (k + 1 < listed && compare_faces(&list[k], &list[k + 1]) == 0) continue;
        list[(*count)++] = list[k];
    }
    return true;
}
