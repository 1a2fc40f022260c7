// SPDX-License-Identifier: GPL-2.0-or-later
// Arrays are shortened in place: what is kept moves towards the front, its order stays.
#include "io/mesh/mesh_pick.h"

#include "base/memory.h"

#include <string.h>

bool mesh_file_pick(const char *path, const char (*names)[GROUP_NAME_SIZE], int32_t count,
                    MeshFile *mesh, Error *err)
{
    int32_t kept = 0, at = 0;   // of what is being shortened
    size_t place = (size_t)mesh->dim * sizeof(double);

    // The numbers that nodes and elements get; -1: left out.
    int32_t *node = NEW_ARRAY(int32_t, mesh->node_count, err);
    int32_t *element = NEW_ARRAY(int32_t, mesh->element_count, err);
    TRY(node && element);
    for (int32_t i = 0; i < mesh->node_count; i++) node[i] = -1;
    for (int32_t e = 0; e < mesh->element_count; e++) element[e] = -1;
    for (int32_t k = 0; k < count; k++) {
        const MeshGroup *region = mesh_file_group(mesh, path, names[k], mesh->dim, err);
        TRY(region);
        for (int32_t i = 0; i < region->element_count; i++) {
            int32_t e = region->elements[i];
            element[e] = 0;
            for (int32_t a = mesh->first_node[e]; a < mesh->first_node[e + 1]; a++)
                node[mesh->element_nodes[a]] = 0;
        }
    }

    // Nodes.
    for (int32_t i = 0; i < mesh->node_count; i++) {
        if (node[i] < 0) continue;
        memmove(mesh->position + (int64_t)mesh->dim * kept, mesh->position + (int64_t)mesh->dim * i,
                place);
        mesh->node_number[kept] = mesh->node_number[i];
        node[i] = kept++;
    }
    mesh->node_count = kept;

    // Elements.
    kept = 0;
    for (int32_t e = 0; e < mesh->element_count; e++) {
        int32_t begin = mesh->first_node[e], end = mesh->first_node[e + 1];
        if (element[e] < 0) continue;
        mesh->element_number[kept] = mesh->element_number[e];
        mesh->kind[kept] = mesh->kind[e];
        mesh->first_node[kept] = at;
        for (int32_t a = begin; a < end; a++)
            mesh->element_nodes[at++] = node[mesh->element_nodes[a]];
        element[e] = kept++;
    }
    mesh->first_node[kept] = at;
    mesh->element_count = kept;

    // Groups, as far as something of them is left: of the nodes and elements those that the mesh
    // keeps, by their new numbers, and the faces that have all of their nodes.
    kept = 0;
    for (int32_t g = 0; g < mesh->group_count; g++) {
        MeshGroup *group = &mesh->groups[g];
        int32_t faces = 0, nodes = 0, elements = 0, width = group->nodes_per_face;
        for (int32_t f = 0; f < group->face_count; f++) {
            const int32_t *face = group->face_nodes + (int64_t)f * width;
            bool whole = true;
            for (int32_t a = 0; a < width && face[a] >= 0; a++) whole = whole && node[face[a]] >= 0;
            if (!whole) continue;
            for (int32_t a = 0; a < width; a++)
                group->face_nodes[(int64_t)faces * width + a] = face[a] < 0 ? -1 : node[face[a]];
            faces++;
        }
        for (int32_t k = 0; k < group->node_count; k++)
            if (node[group->nodes[k]] >= 0) group->nodes[nodes++] = node[group->nodes[k]];
        for (int32_t k = 0; k < group->element_count; k++)
            if (element[group->elements[k]] >= 0)
                group->elements[elements++] = element[group->elements[k]];
        // A face of the rest may have left a node of its rim that is the block's too.
        bool left = group->face_count > 0 ? faces > 0 : nodes > 0 || elements > 0;
        group->face_count = faces;
        group->node_count = nodes;
        group->element_count = elements;
        if (left)
            mesh->groups[kept++] = *group;
        else
            memory_free_all(group->face_nodes, group->nodes, group->elements);
    }
    mesh->group_count = kept;

    // A boundary has only the nodes of the faces that are kept: 0 for those, -1 else.
    int32_t *on_face = node;
    for (int32_t g = 0; g < mesh->group_count; g++) {
        MeshGroup *group = &mesh->groups[g];
        int32_t nodes = 0;
        if (group->nodes_per_face == 0) continue;
        for (int32_t i = 0; i < mesh->node_count; i++) on_face[i] = -1;
        for (int64_t a = 0; a < (int64_t)group->face_count * group->nodes_per_face; a++)
            if (group->face_nodes[a] >= 0) on_face[group->face_nodes[a]] = 0;
        for (int32_t k = 0; k < group->node_count; k++)
            if (on_face[group->nodes[k]] == 0) group->nodes[nodes++] = group->nodes[k];
        group->node_count = nodes;
    }
cleanup:
    memory_free_all(node, element);
    return error_is_clean(err);
}
