// SPDX-License-Identifier: GPL-2.0-or-later
#include "fem/mesh_pieces.h"

#include "base/memory.h"
#include "fem/mesh_faces.h"

#include <stdio.h>
#include <string.h>

static int32_t root_of(int32_t *parent, int32_t node)
{
    while (parent[node] != node) node = parent[node] = parent[parent[node]];
    return node;
}

bool mesh_pieces_find(const Mesh *mesh, const MeshBoundary *whole, MeshPieces *pieces, Error *err)
{
    int32_t width = whole->nodes_per_face;
    *pieces = (MeshPieces){0};

    // Number of the piece that each node of the mesh is on, -1: not on the boundary.
    int32_t *number = NULL, *parent = NEW_ARRAY(int32_t, mesh->node_count, err);
    if (!parent || !(number = NEW_ARRAY(int32_t, mesh->node_count, err))) goto cleanup;
    for (int32_t i = 0; i < mesh->node_count; i++) parent[i] = i, number[i] = -1;
    for (int32_t f = 0; f < whole->face_count; f++) {
        FaceNodes face = mesh_boundary_face(whole, f);
        for (int32_t a = 1; a < element_node_count(face.kind); a++)
            parent[root_of(parent, face.node[a])] = root_of(parent, face.node[0]);
    }
    for (int32_t k = 0; k < whole->node_count; k++) {
        int32_t node = whole->nodes[k], root = root_of(parent, node);
        if (number[root] < 0) number[root] = pieces->count++;
        number[node] = number[root];
    }

    // Nodes and faces of each piece.
    pieces->piece = memory_array(pieces->count, sizeof *pieces->piece, err);
    pieces->name = memory_array(pieces->count, sizeof *pieces->name, err);
    int32_t *nodes = pieces->nodes = NEW_ARRAY(int32_t, whole->node_count, err);
    int32_t *faces = pieces->face_nodes =
        NEW_ARRAY(int32_t, (int64_t)whole->face_count * width, err);
    if (!error_is_clean(err)) goto cleanup;
    for (int32_t p = 0; p < pieces->count; p++) {
        MeshBoundary *piece = &pieces->piece[p];
        *piece = (MeshBoundary){.name = pieces->name[p],
                                .dim = whole->dim,
                                .nodes_per_face = width,
                                .face_nodes = faces,
                                .nodes = nodes};
        if (pieces->count == 1)
            snprintf(pieces->name[p], GROUP_NAME_SIZE, "%s", whole->name);
        else
            snprintf(pieces->name[p], GROUP_NAME_SIZE, "%.51s/%d", whole->name, p + 1);
        for (int32_t k = 0; k < whole->node_count; k++)
            if (number[whole->nodes[k]] == p) nodes[piece->node_count++] = whole->nodes[k];
        for (int32_t f = 0; f < whole->face_count; f++) {
            const int32_t *face = whole->face_nodes + (int64_t)f * width;
            if (number[face[0]] != p) continue;
            memcpy(faces + (int64_t)width * piece->face_count++, face,
                   (size_t)width * sizeof *face);
        }
        nodes += piece->node_count;
        faces += (int64_t)width * piece->face_count;
    }
cleanup:
    memory_free_all(number, parent);
    return error_is_clean(err);
}

void mesh_pieces_destroy(MeshPieces *pieces)
{
    memory_free_all(pieces->piece, pieces->name, pieces->nodes, pieces->face_nodes);
    *pieces = (MeshPieces){0};
}

bool mesh_piece_is_of(const char *name, const char *group)
{
    size_t length = strlen(group);
    if (strcmp(name, group) == 0) return true;
    if (strncmp(name, group, length) != 0 || name[length] != '/') return false;
    const char *number = name + length + 1;
    return *number && strspn(number, "0123456789") == strlen(number);
}
