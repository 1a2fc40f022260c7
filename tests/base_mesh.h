// SPDX-License-Identifier: GPL-2.0-or-later
// A block on a base, out of two meshes written by hand (block_mesh.h, space_mesh.h): the second one
// is moved below z = 0, and its groups become floor, bottom, base_rod and base_leading.
#ifndef AMONTONS_TESTS_BASE_MESH_H
#define AMONTONS_TESTS_BASE_MESH_H

#include "base/memory.h"
#include "fem/mesh.h"

#include <stdio.h>
#include <string.h>

// Appends a list of nodes or elements, each `shift` more, to another one.
static inline int32_t *base_join(const int32_t *one, int64_t count, const int32_t *other,
                                 int64_t more, int32_t shift)
{
    Error err = {0};
    int32_t *all = NEW_ARRAY(int32_t, count + more, &err);
    memcpy(all, one, (size_t)count * sizeof *all);
    for (int64_t k = 0; k < more; k++) all[count + k] = other[k] < 0 ? -1 : other[k] + shift;
    return all;
}

static inline const char *base_group_name(const char *name)
{
    static const char *const names[][2] = {
        {"top", "floor"}, {"contact", "bottom"}, {"rod", "base_rod"}, {"leading", "base_leading"}};
    for (int k = 0; k < 4; k++)
        if (strcmp(name, names[k][0]) == 0) return names[k][1];
    return name;
}

// Both files are taken over. along: where the base begins; its upper side is at z = 0.
static inline MeshFile base_file(MeshFile block, MeshFile base, double along)
{
    Error err = {0};
    int32_t dim = block.dim, first = block.node_count, elements = block.element_count;
    int32_t filled = block.first_node[elements], more = base.first_node[base.element_count];
    double high = 0;
    MeshFile both = {.dim = dim,
                     .node_count = first + base.node_count,
                     .element_count = elements + base.element_count,
                     .group_count = block.group_count + base.group_count};
    both.position = NEW_ARRAY(double, (int64_t)dim *both.node_count, &err);
    both.node_number = NEW_ARRAY(int64_t, both.node_count, &err);
    both.element_number = NEW_ARRAY(int64_t, both.element_count, &err);
    both.kind = NEW_ARRAY(uint8_t, both.element_count, &err);
    both.first_node =
        base_join(block.first_node, elements + 1, base.first_node + 1, base.element_count, filled);
    both.element_nodes = base_join(block.element_nodes, filled, base.element_nodes, more, first);
    both.groups = NEW_ARRAY(MeshGroup, both.group_count, &err);
    for (int32_t i = 0; i < base.node_count; i++)
        if (base.position[dim * i + dim - 1] > high) high = base.position[dim * i + dim - 1];
    memcpy(both.position, block.position, (size_t)(dim * first) * sizeof(double));
    for (int32_t k = 0; k < dim * base.node_count; k++)
        both.position[dim * first + k] = base.position[k] + (k % dim == 0         ? along
                                                             : k % dim == dim - 1 ? -high
                                                                                  : 0);
    for (int32_t i = 0; i < both.node_count; i++) both.node_number[i] = i + 1;
    for (int32_t e = 0; e < both.element_count; e++) {
        both.element_number[e] = e + 1;
        both.kind[e] = e < elements ? block.kind[e] : base.kind[e - elements];
    }
    for (int32_t g = 0; g < both.group_count; g++) {
        bool upper = g < block.group_count;
        MeshGroup *group = &both.groups[g];
        *group = upper ? block.groups[g] : base.groups[g - block.group_count];
        group->number = g + 1;
        if (upper) continue;
        snprintf(group->name, sizeof group->name, "%s", base_group_name(group->name));
        int64_t places = (int64_t)group->face_count * group->nodes_per_face;
        int32_t *faces = group->face_nodes, *nodes = group->nodes;
        group->face_nodes = base_join(faces, 0, faces, places, first);
        group->nodes = base_join(nodes, 0, nodes, group->node_count, first);
        memory_free_all(faces, nodes);
    }
    memory_free(block.groups);
    memory_free(base.groups);
    block.groups = base.groups = NULL;
    block.group_count = base.group_count = 0;
    mesh_file_destroy(&block);
    mesh_file_destroy(&base);
    return both;
}

// With the floor found.
static inline bool base_build(MeshFile block, MeshFile base, double along, Mesh *mesh, Error *err)
{
    MeshFile both = base_file(block, base, along);
    return mesh_build_on_base(&both, "block on a base by hand", "floor", mesh, err) &&
           floor_find(NULL, 0, "floor", mesh, err);
}

#endif
