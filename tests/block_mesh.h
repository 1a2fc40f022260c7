// SPDX-License-Identifier: GPL-2.0-or-later
// Rectangular blocks of any element, written down without gmsh: corner nodes on a grid, those
// inside moved at random if asked, mid-side nodes half-way, centre nodes in the middle. Groups:
// contact (z = 0), leading, top, rod (x = 0).
#ifndef AMONTONS_TESTS_BLOCK_MESH_H
#define AMONTONS_TESTS_BLOCK_MESH_H

#include "block_lattice.h"
#include "fem/mesh.h"

// Where the nodes of an element lie in its cell, in half cells from the lower left corner.
static inline const int8_t (*block_pattern(ElementKind kind, int32_t half))[2]
{
    static const int8_t quad[][2] = {{0, 0}, {2, 0}, {2, 2}, {0, 2}, {1, 0},
                                     {2, 1}, {1, 2}, {0, 1}, {1, 1}};
    static const int8_t lower[][2] = {{0, 0}, {2, 0}, {2, 2}, {1, 0}, {2, 1}, {1, 1}};
    static const int8_t upper[][2] = {{0, 0}, {2, 2}, {0, 2}, {1, 1}, {1, 2}, {0, 1}};
    if (kind == ELEMENT_T3 || kind == ELEMENT_T6) return half ? upper : lower;
    return quad;
}

static inline void block_fill_elements(const BlockDef *def, const BlockLattice *lattice,
                                       MeshFile *file)
{
    Error err = {0};
    bool triangles = def->kind == ELEMENT_T3 || def->kind == ELEMENT_T6;
    int32_t halves = triangles ? 2 : 1, width = element_node_count(def->kind), filled = 0;
    file->element_count = halves * def->nx * def->nz;
    file->kind = NEW_ARRAY(uint8_t, file->element_count, &err);
    file->element_number = NEW_ARRAY(int64_t, file->element_count, &err);
    file->first_node = NEW_ARRAY(int32_t, file->element_count + 1, &err);
    file->element_nodes = NEW_ARRAY(int32_t, width * file->element_count, &err);
    for (int32_t e = 0; e < file->element_count; e++) {
        int32_t cell = e / halves, i = cell % def->nx, k = cell / def->nx;
        const int8_t(*pattern)[2] = block_pattern(def->kind, e % halves);
        for (int32_t a = 0; a < width; a++)
            file->element_nodes[filled++] =
                lattice_node(lattice, lattice->order * i + lattice->order * pattern[a][0] / 2,
                             lattice->order * k + lattice->order * pattern[a][1] / 2);
        file->kind[e] = (uint8_t)def->kind;
        file->element_number[e] = e + 1;
        file->first_node[e + 1] = filled;
    }
}

static inline int32_t ascending(const void *a, const void *b)
{
    return *(const int32_t *)a - *(const int32_t *)b;
}

// A straight row of lattice points from (i, k) on, `count` edges long.
typedef struct BlockRow {
    const char *name;
    int32_t i, k, count;
    bool upwards;
} BlockRow;

static inline void block_add_curve(const BlockLattice *lattice, BlockRow row, MeshFile *file)
{
    Error err = {0};
    int32_t width = lattice->order + 1, order = lattice->order;
    MeshGroup *group = &file->groups[file->group_count++];
    snprintf(group->name, sizeof group->name, "%s", row.name);
    group->dimension = 1;
    group->number = file->group_count;
    group->face_count = row.count;
    group->nodes_per_face = width;
    group->face_nodes = NEW_ARRAY(int32_t, width * row.count, &err);
    group->nodes = NEW_ARRAY(int32_t, order * row.count + 1, &err);
    for (int32_t m = 0; m <= order * row.count; m++)
        group->nodes[group->node_count++] = row.upwards ? lattice_node(lattice, row.i, row.k + m)
                                                        : lattice_node(lattice, row.i + m, row.k);
    for (int32_t e = 0; e < row.count; e++) {
        group->face_nodes[width * e] = group->nodes[order * e];
        group->face_nodes[width * e + 1] = group->nodes[order * (e + 1)];
        if (order == 2) group->face_nodes[width * e + 2] = group->nodes[order * e + 1];
    }
    qsort(group->nodes, (size_t)group->node_count, sizeof(int32_t), ascending);
}

static inline MeshFile block_file(const BlockDef *def)
{
    Error err = {0};
    MeshFile file = {.dim = 2};
    int32_t order = def->kind == ELEMENT_T3 || def->kind == ELEMENT_Q4 ? 1 : 2;
    BlockLattice lattice = {
        .order = order, .columns = order * def->nx + 1, .rows = order * def->nz + 1};
    block_place_nodes(def, &lattice, &file);
    block_fill_elements(def, &lattice, &file);
    file.node_number = NEW_ARRAY(int64_t, file.node_count, &err);
    for (int32_t k = 0; k < file.node_count; k++) file.node_number[k] = k + 1;
    file.groups = NEW_ARRAY(MeshGroup, 4, &err);
    block_add_curve(&lattice, (BlockRow){"contact", 0, 0, def->nx, false}, &file);
    block_add_curve(&lattice, (BlockRow){"leading", order * def->nx, 0, def->nz, true}, &file);
    block_add_curve(&lattice, (BlockRow){"top", 0, order * def->nz, def->nx, false}, &file);
    block_add_curve(&lattice, (BlockRow){"rod", 0, 0, def->nz, true}, &file);
    free(lattice.node);
    return file;
}

static inline void block_build(const BlockDef *def, Mesh *mesh)
{
    Error err = {0};
    MeshFile file = block_file(def);
    if (!mesh_build(&file, "block by hand", mesh, &err)) fail_msg("%s", err.message);
}

#endif
