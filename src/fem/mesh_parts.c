// SPDX-License-Identifier: GPL-2.0-or-later
#include "fem/mesh_parts.h"

#include "base/memory.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

int32_t mesh_part_root(int32_t *parent, int32_t i)
{
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
}

bool mesh_parts_find(const Mesh *mesh, MeshParts *parts, Error *err)
{
    int32_t *parent = NEW_ARRAY(int32_t, mesh->node_count, err);
    *parts = (MeshParts){0};
    TRY(parent);
    TRY((parts->part = NEW_ARRAY(int32_t, mesh->node_count, err)));
    for (int32_t i = 0; i < mesh->node_count; i++) parent[i] = i, parts->part[i] = -1;
    for (int32_t e = 0; e < mesh->element_count; e++)
        for (int32_t k = mesh->first_node[e] + 1; k < mesh->first_node[e + 1]; k++) {
            int32_t one = mesh_part_root(parent, mesh->element_nodes[k - 1]);
            parent[mesh_part_root(parent, mesh->element_nodes[k])] = one;
        }
    for (int32_t i = 0; i < mesh->node_count; i++) {
        int32_t root = mesh_part_root(parent, i);
        if (parts->part[root] < 0) parts->part[root] = parts->count++;
        parts->part[i] = parts->part[root];
    }
cleanup:
    memory_free(parent);
    return error_is_clean(err);
}

void mesh_parts_destroy(MeshParts *parts)
{
    memory_free(parts->part);
    *parts = (MeshParts){0};
}

static bool group_has(const Mesh *mesh, const MeshGroup *group, const MeshParts *parts,
                      int32_t part)
{
    for (int32_t k = 0; k < group->node_count; k++)
        if (parts->part[group->nodes[k]] == part) return true;
    for (int32_t k = 0; k < group->element_count; k++)
        if (parts->part[mesh->element_nodes[mesh->first_node[group->elements[k]]]] == part)
            return true;
    return false;
}

// Appends the names of the groups of a part, regions only or all.
static int list_groups(const Mesh *mesh, const MeshParts *parts, int32_t part, bool regions,
                       const char *quote, char *text, int size)
{
    int length = 0, count = 0;
    for (int32_t g = 0; g < mesh->group_count && length < size - 1; g++) {
        const MeshGroup *group = &mesh->groups[g];
        if (regions && group->dimension != mesh->dim) continue;
        if (!group_has(mesh, group, parts, part)) continue;
        length += snprintf(text + length, (size_t)(size - length), "%s%s%s%s", count++ ? ", " : "",
                           quote, group->name, quote);
    }
    return count;
}

const char *mesh_part_text(const Mesh *mesh, const MeshParts *parts, int32_t part,
                           char text[PART_TEXT_SIZE])
{
    int32_t nodes = 0, up = mesh->dim - 1;
    MeshPlace low, high;
    char groups[PART_TEXT_SIZE / 2] = "";
    for (int32_t d = 0; d < DIM_MAX; d++) low[d] = INFINITY, high[d] = -INFINITY;
    for (int32_t i = 0; i < mesh->node_count; i++) {
        if (parts->part[i] != part) continue;
        nodes++;
        for (int32_t d = 0; d < mesh->dim; d++) {
            low[d] = fmin(low[d], mesh_place(mesh, i)[d]);
            high[d] = fmax(high[d], mesh_place(mesh, i)[d]);
        }
    }
    int count = list_groups(mesh, parts, part, false, "'", groups, (int)sizeof groups);
    snprintf(text, PART_TEXT_SIZE, "%d nodes in x = %g ... %g, z = %g ... %g, %s%s", nodes, low[0],
             high[0], low[up], high[up], count ? "groups " : "in no group", groups);
    return text;
}

const char *mesh_parts_advice(const Mesh *mesh, const MeshParts *parts, char text[PART_TEXT_SIZE])
{
    int32_t best = 0, most = -1;
    char regions[PART_TEXT_SIZE / 2] = "";
    for (int32_t part = 0; part < parts->count; part++) {
        int32_t known = 0;
        for (int32_t g = 0; g < mesh->group_count; g++) {
            // Names that a scene gives the boundaries of a block where it says nothing else.
            const char *name = mesh->groups[g].name;
            bool of_block = strncmp(name, "contact", strlen("contact")) == 0 ||
                            strcmp(name, "top") == 0 || strcmp(name, "rod") == 0;
            known += of_block && group_has(mesh, &mesh->groups[g], parts, part);
        }
        if (known <= most) continue;
        most = known;
        best = part;
    }
    int count = list_groups(mesh, parts, best, true, "", regions, (int)sizeof regions);
    if (count == 0)
        snprintf(
            text, PART_TEXT_SIZE,
            "give each part a physical %s of its own, then `groups: {body: NAME}` in the scene "
            "picks one",
            mesh->dim == 2 ? "surface" : "volume");
    else
        snprintf(text, PART_TEXT_SIZE, "`groups: {body: %s%s%s}` in the scene picks one",
                 count > 1 ? "[" : "", regions, count > 1 ? "]" : "");
    return text;
}

bool mesh_parts_refuse(const Mesh *mesh, const MeshParts *parts, Error *err)
{
    char first[PART_TEXT_SIZE], second[PART_TEXT_SIZE], advice[PART_TEXT_SIZE];
    return REFUSE(
        err,
        "%s: the mesh has %d parts that share no node, and a scene is one block, on a rigid "
        "floor or on a base: %s; and %s%s: for a base that deforms call its upper side 'floor' "
        "(groups.floor); for the block alone %s (what is to be one block must share points and "
        "lines in the .geo: `Coherence;`, `Coherence Mesh;`)",
        mesh->path, parts->count, mesh_part_text(mesh, parts, 0, first),
        mesh_part_text(mesh, parts, 1, second), parts->count > 2 ? "; ..." : "",
        mesh_parts_advice(mesh, parts, advice));
}
