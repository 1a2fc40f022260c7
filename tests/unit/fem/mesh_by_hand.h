// SPDX-License-Identifier: GPL-2.0-or-later
// Small meshes written down in a test, without gmsh. Node and element numbers count from 1, as
// gmsh's do.
#ifndef AMONTONS_TESTS_MESH_BY_HAND_H
#define AMONTONS_TESTS_MESH_BY_HAND_H

#include "base/memory.h"
#include "io/mesh/mesh_file.h"

#include <stdio.h>
#include <string.h>

static inline void *hand_copy(const void *from, int64_t count, size_t size)
{
    Error err = {0};
    void *to = memory_array(count, size, &err);
    if (to) memcpy(to, from, (size_t)count * size);
    return to;
}

static inline int64_t *hand_numbers(int32_t count)
{
    Error err = {0};
    int64_t *numbers = NEW_ARRAY(int64_t, count, &err);
    for (int32_t k = 0; numbers && k < count; k++) numbers[k] = k + 1;
    return numbers;
}

// Elements of one kind. positions: [nodes][2]; corners: [elements * nodes of the kind].
static inline MeshFile hand_mesh(int32_t nodes, const double (*positions)[2], ElementKind kind,
                                 int32_t elements, const int32_t *corners)
{
    Error err = {0};
    int32_t width = element_node_count(kind);
    MeshFile mesh = {.dim = 2, .node_count = nodes, .element_count = elements};
    mesh.position = hand_copy(positions, 2 * nodes, sizeof(double));
    mesh.node_number = hand_numbers(nodes);
    mesh.element_number = hand_numbers(elements);
    mesh.element_nodes = hand_copy(corners, (int64_t)elements * width, sizeof(int32_t));
    mesh.kind = NEW_ARRAY(uint8_t, elements, &err);
    mesh.first_node = NEW_ARRAY(int32_t, elements + 1, &err);
    mesh.groups = NEW_ARRAY(MeshGroup, 8, &err);
    for (int32_t e = 0; e < elements; e++) {
        mesh.kind[e] = (uint8_t)kind;
        mesh.first_node[e + 1] = (e + 1) * width;
    }
    return mesh;
}

// Adds a curve of two-node edges [edges][2]; at most eight groups.
static inline void hand_curve(MeshFile *mesh, const char *name, int32_t edges,
                              const int32_t (*pairs)[2])
{
    Error err = {0};
    MeshGroup *group = &mesh->groups[mesh->group_count++];
    snprintf(group->name, sizeof group->name, "%s", name);
    group->dimension = 1;
    group->number = mesh->group_count;
    group->face_count = edges;
    group->nodes_per_face = 2;
    group->face_nodes = hand_copy(pairs, 2 * edges, sizeof(int32_t));
    group->nodes = NEW_ARRAY(int32_t, 2 * edges, &err);
    for (int32_t i = 0; i < mesh->node_count; i++) {
        bool found = false;
        for (int32_t k = 0; k < 2 * edges; k++) found = found || group->face_nodes[k] == i;
        if (found) group->nodes[group->node_count++] = i;
    }
}

#endif
