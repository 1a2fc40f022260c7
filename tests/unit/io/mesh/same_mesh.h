// SPDX-License-Identifier: GPL-2.0-or-later
// Two meshes that are the same to the bit: positions, numbers, elements, groups.
#ifndef AMONTONS_TESTS_SAME_MESH_H
#define AMONTONS_TESTS_SAME_MESH_H

#include "io/mesh/mesh_file.h"
#include "near.h"

#define SAME_ITEMS(one, two, count) assert_memory_equal(one, two, (size_t)(count) * sizeof *(one))

static inline void assert_same_group(const MeshGroup *group, const MeshGroup *other)
{
    assert_string_equal(group->name, other->name);
    assert_int_equal(group->dimension, other->dimension);
    assert_int_equal(group->number, other->number);
    assert_int_equal(group->face_count, other->face_count);
    assert_int_equal(group->nodes_per_face, other->nodes_per_face);
    assert_int_equal(group->node_count, other->node_count);
    assert_int_equal(group->element_count, other->element_count);
    int32_t ends = group->face_count * group->nodes_per_face;
    if (ends) SAME_ITEMS(group->face_nodes, other->face_nodes, ends);
    if (group->node_count) SAME_ITEMS(group->nodes, other->nodes, group->node_count);
    if (group->element_count) SAME_ITEMS(group->elements, other->elements, group->element_count);
}

static inline void assert_same_mesh(const MeshFile *mesh, const MeshFile *other)
{
    assert_int_equal(mesh->node_count, other->node_count);
    assert_int_equal(mesh->element_count, other->element_count);
    assert_int_equal(mesh->group_count, other->group_count);
    SAME_ITEMS(mesh->node_number, other->node_number, mesh->node_count);
    SAME_ITEMS(mesh->element_number, other->element_number, mesh->element_count);
    SAME_ITEMS(mesh->kind, other->kind, mesh->element_count);
    SAME_ITEMS(mesh->first_node, other->first_node, mesh->element_count + 1);
    SAME_ITEMS(mesh->element_nodes, other->element_nodes, mesh->first_node[mesh->element_count]);
    SAME_ITEMS(mesh->position, other->position, 2 * mesh->node_count);
    for (int32_t k = 0; k < mesh->group_count; k++)
        assert_same_group(&mesh->groups[k], &other->groups[k]);
}

#endif
