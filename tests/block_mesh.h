// SPDX-License-Identifier: GPL-2.0-or-later
// Rectangular blocks of any element, written down without gmsh: corner nodes on a grid, those
// inside moved at random if asked, mid-side nodes half-way, centre nodes in the middle. Groups:
// contact (z = 0), leading, top, rod (x = 0).
#ifndef AMONTONS_TESTS_BLOCK_MESH_H
#define AMONTONS_TESTS_BLOCK_MESH_H

#include "base/memory.h"
#include "bulk/mesh.h"
#include "near.h"
#include "random_numbers.h"

typedef struct BlockDef {
    ElementKind kind;
    int32_t nx, nz;   // cells; a triangle is half of one
    double length, height;
    double distortion;   // how far inner corners are moved at most, in cells; < 0.3
    uint64_t seed;
} BlockDef;

// The lattice that holds the nodes: every second one is a corner in order 2.
typedef struct BlockLattice {
    int32_t order, columns, rows;
    int32_t *node;   // [columns * rows] node index, or -1
} BlockLattice;

static inline int32_t lattice_node(const BlockLattice *lattice, int32_t i, int32_t k)
{
    return lattice->node[k * lattice->columns + i];
}

static inline void block_place_nodes(const BlockDef *def, BlockLattice *lattice, MeshFile *file)
{
    Error err = {0};
    Random random = {.state = def->seed};
    int32_t order = lattice->order, columns = lattice->columns, rows = lattice->rows;
    double *place = calloc(2 * (size_t)(columns * rows), sizeof *place);
    for (int32_t k = 0; k < rows; k += order) {
        for (int32_t i = 0; i < columns; i += order) {
            double *at = place + 2 * (k * columns + i), move = def->distortion;
            if (i == 0 || k == 0 || i == columns - 1 || k == rows - 1) move = 0;
            at[0] = def->length / def->nx * (i / order + random_between(&random, -move, move));
            at[1] = def->height / def->nz * (k / order + random_between(&random, -move, move));
        }
    }
    // Half-way between the corners on both sides; a centre between two opposite ones of its cell
    // (T6: the diagonal's middle), or in the middle of four.
    bool triangles = def->kind == ELEMENT_T6;
    for (int32_t k = 0; order == 2 && k < rows; k++) {
        for (int32_t i = 0; i < columns; i++) {
            int32_t a = i % 2, b = k % 2;
            for (int d = 0; d < 2 && (a || b); d++) {
                double low = place[2 * ((k - b) * columns + i - a) + d];
                double high = place[2 * ((k + b) * columns + i + a) + d], sum = (low + high) / 2;
                if (a && b && !triangles)
                    sum = (2 * sum + place[2 * ((k - 1) * columns + i + 1) + d] +
                           place[2 * ((k + 1) * columns + i - 1) + d]) /
                          4;
                place[2 * (k * columns + i) + d] = sum;
            }
        }
    }
    file->position = NEW_ARRAY(double, 2 * columns * rows, &err);
    lattice->node = calloc((size_t)(columns * rows), sizeof *lattice->node);
    for (int32_t m = 0; m < columns * rows; m++) {
        bool centre = order == 2 && (m % columns) % 2 && (m / columns) % 2;
        lattice->node[m] = centre && def->kind == ELEMENT_Q8 ? -1 : file->node_count++;
        if (lattice->node[m] >= 0)
            memcpy(file->position + 2 * lattice->node[m], place + 2 * m, 2 * sizeof *place);
    }
    free(place);
}

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

// The straight row of lattice points from (i, k) on, `count` edges long.
static inline void block_add_curve(const BlockLattice *lattice, const char *name, int32_t i,
                                   int32_t k, bool upwards, int32_t count, MeshFile *file)
{
    Error err = {0};
    int32_t width = lattice->order + 1, order = lattice->order;
    MeshGroup *group = &file->groups[file->group_count++];
    snprintf(group->name, sizeof group->name, "%s", name);
    group->dimension = 1;
    group->number = file->group_count;
    group->edge_count = count;
    group->nodes_per_edge = width;
    group->edge_nodes = NEW_ARRAY(int32_t, width * count, &err);
    group->nodes = NEW_ARRAY(int32_t, order * count + 1, &err);
    for (int32_t m = 0; m <= order * count; m++)
        group->nodes[group->node_count++] = upwards ? lattice_node(lattice, i, k + m)
                                                    : lattice_node(lattice, i + m, k);
    for (int32_t e = 0; e < count; e++) {
        group->edge_nodes[width * e] = group->nodes[order * e];
        group->edge_nodes[width * e + 1] = group->nodes[order * (e + 1)];
        if (order == 2) group->edge_nodes[width * e + 2] = group->nodes[order * e + 1];
    }
    qsort(group->nodes, (size_t)group->node_count, sizeof(int32_t), ascending);
}

static inline MeshFile block_file(const BlockDef *def)
{
    Error err = {0};
    MeshFile file = {0};
    int32_t order = def->kind == ELEMENT_T3 || def->kind == ELEMENT_Q4 ? 1 : 2;
    BlockLattice lattice = {
        .order = order, .columns = order * def->nx + 1, .rows = order * def->nz + 1};
    block_place_nodes(def, &lattice, &file);
    block_fill_elements(def, &lattice, &file);
    file.node_number = NEW_ARRAY(int64_t, file.node_count, &err);
    for (int32_t k = 0; k < file.node_count; k++) file.node_number[k] = k + 1;
    file.groups = NEW_ARRAY(MeshGroup, 4, &err);
    block_add_curve(&lattice, "contact", 0, 0, false, def->nx, &file);
    block_add_curve(&lattice, "leading", order * def->nx, 0, true, def->nz, &file);
    block_add_curve(&lattice, "top", 0, order * def->nz, false, def->nx, &file);
    block_add_curve(&lattice, "rod", 0, 0, true, def->nz, &file);
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
