// SPDX-License-Identifier: GPL-2.0-or-later
// Arrays are shortened in place: what is kept moves towards the front, its order stays.
#include "io/mesh/mesh_pick.h"

#include "base/memory.h"

#include <string.h>

// The numbers that nodes and elements get; -1: left out.
typedef struct Kept {
    int32_t *node, *element;   // [node_count], [element_count]; owned
} Kept;

static bool mark_regions(const char *path, const char (*names)[GROUP_NAME_SIZE], int32_t count,
                         const MeshFile *mesh, Kept *kept, Error *err)
{
    for (int32_t i = 0; i < mesh->node_count; i++) kept->node[i] = -1;
    for (int32_t e = 0; e < mesh->element_count; e++) kept->element[e] = -1;
    for (int32_t k = 0; k < count; k++) {
        const MeshGroup *region = mesh_file_group(mesh, path, names[k], mesh->dim, err);
        if (!region) return false;
        for (int32_t i = 0; i < region->element_count; i++) {
            int32_t e = region->elements[i];
            kept->element[e] = 0;
            for (int32_t a = mesh->first_node[e]; a < mesh->first_node[e + 1]; a++)
                kept->node[mesh->element_nodes[a]] = 0;
        }
    }
    return true;
}

static void keep_nodes(const Kept *kept, MeshFile *mesh)
{
    int32_t count = 0;
    for (int32_t i = 0; i < mesh->node_count; i++) {
        if (kept->node[i] < 0) continue;
        memmove(mesh->position + (int64_t)mesh->dim * count,
                mesh->position + (int64_t)mesh->dim * i, (size_t)mesh->dim * sizeof(double));
        mesh->node_number[count] = mesh->node_number[i];
        kept->node[i] = count++;
    }
    mesh->node_count = count;
}

static void keep_elements(const Kept *kept, MeshFile *mesh)
{
    int32_t count = 0, at = 0;
    for (int32_t e = 0; e < mesh->element_count; e++) {
        int32_t begin = mesh->first_node[e], end = mesh->first_node[e + 1];
        if (kept->element[e] < 0) continue;
        mesh->element_number[count] = mesh->element_number[e];
        mesh->kind[count] = mesh->kind[e];
        mesh->first_node[count] = at;
        for (int32_t a = begin; a < end; a++)
            mesh->element_nodes[at++] = kept->node[mesh->element_nodes[a]];
        kept->element[e] = count++;
    }
    mesh->first_node[count] = at;
    mesh->element_count = count;
}

// Keeps the nodes and elements of a group that the mesh keeps, and the faces that have all of their
// nodes. False: nothing of the group is left.
static bool keep_group(const Kept *kept, MeshGroup *group)
{
    int32_t faces = 0, nodes = 0, elements = 0, width = group->nodes_per_face;
    for (int32_t f = 0; f < group->face_count; f++) {
        const int32_t *face = group->face_nodes + (int64_t)f * width;
        bool whole = true;
        for (int32_t a = 0; a < width && face[a] >= 0; a++)
            whole = whole && kept->node[face[a]] >= 0;
        if (!whole) continue;
        for (int32_t a = 0; a < width; a++)
            group->face_nodes[(int64_t)faces * width + a] = face[a] < 0 ? -1 : kept->node[face[a]];
        faces++;
    }
    for (int32_t k = 0; k < group->node_count; k++)
        if (kept->node[group->nodes[k]] >= 0) group->nodes[nodes++] = kept->node[group->nodes[k]];
    for (int32_t k = 0; k < group->element_count; k++)
        if (kept->element[group->elements[k]] >= 0)
            group->elements[elements++] = kept->element[group->elements[k]];
    // A face of the rest may have left a node of its rim that is the block's too.
    bool left = group->face_count > 0 ? faces > 0 : nodes > 0 || elements > 0;
    group->face_count = faces;
    group->node_count = nodes;
    group->element_count = elements;
    return left;
}

// The nodes of the faces that are kept, no others: 0 for those, -1 else.
static void keep_face_nodes(MeshGroup *group, int32_t *on_face, int32_t node_count)
{
    int32_t count = 0;
    if (group->nodes_per_face == 0) return;
    for (int32_t i = 0; i < node_count; i++) on_face[i] = -1;
    for (int64_t a = 0; a < (int64_t)group->face_count * group->nodes_per_face; a++)
        if (group->face_nodes[a] >= 0) on_face[group->face_nodes[a]] = 0;
    for (int32_t k = 0; k < group->node_count; k++)
        if (on_face[group->nodes[k]] == 0) group->nodes[count++] = group->nodes[k];
    group->node_count = count;
}

bool mesh_file_pick(const char *path, const char (*names)[GROUP_NAME_SIZE], int32_t count,
                    MeshFile *mesh, Error *err)
{
    int32_t groups = 0;
    Kept kept = {.node = NEW_ARRAY(int32_t, mesh->node_count, err),
                 .element = NEW_ARRAY(int32_t, mesh->element_count, err)};
    TRY(kept.node && kept.element);
    TRY(mark_regions(path, names, count, mesh, &kept, err));
    keep_nodes(&kept, mesh);
    keep_elements(&kept, mesh);
    for (int32_t g = 0; g < mesh->group_count; g++) {
        MeshGroup *group = &mesh->groups[g];
        if (keep_group(&kept, group))
            mesh->groups[groups++] = *group;
        else
            memory_free_all(group->face_nodes, group->nodes, group->elements);
    }
    mesh->group_count = groups;
    for (int32_t g = 0; g < groups; g++)
        keep_face_nodes(&mesh->groups[g], kept.node, mesh->node_count);
cleanup:
    memory_free_all(kept.node, kept.element);
    return error_is_clean(err);
}
