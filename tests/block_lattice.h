// SPDX-License-Identifier: GPL-2.0-or-later
// Where the nodes of a block_mesh.h stand: corners on a grid, moved at random inside if asked,
// mid-side nodes half-way, centre nodes in the middle.
#ifndef AMONTONS_TESTS_BLOCK_LATTICE_H
#define AMONTONS_TESTS_BLOCK_LATTICE_H

#include "base/memory.h"
#include "io/mesh/mesh_file.h"
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

#endif
