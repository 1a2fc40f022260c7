// SPDX-License-Identifier: GPL-2.0-or-later
// Where the nodes of a space_mesh.h stand: on a lattice of half cells, corners inside moved at
// random if asked, all others half way between corners.
#ifndef AMONTONS_TESTS_SPACE_LATTICE_H
#define AMONTONS_TESTS_SPACE_LATTICE_H

#include "io/mesh/mesh_file.h"
#include "near.h"
#include "random_numbers.h"

typedef struct SpaceDef {
    ElementKind kind;
    int32_t cells[3];
    double size[3];
    double distortion;   // how far inner corners are moved at most, in cells; < 0.2
    uint64_t seed;
} SpaceDef;

// Corners of the parts of a cell, in the order of the hexahedron's corners: bit d of a number is
// the place along axis d.
typedef struct SpaceParts {
    int32_t count;
    uint8_t corner[6][8];
} SpaceParts;

// Tetrahedra: one for each way from corner 0 to corner 7 along the axes, so that neighbours fit.
static inline SpaceParts space_parts(ElementKind kind)
{
    SpaceParts cell = {1, {{0, 1, 3, 2, 4, 5, 7, 6}}};
    SpaceParts wedges = {2, {{0, 1, 3, 4, 5, 7}, {0, 3, 2, 4, 7, 6}}};
    SpaceParts tetrahedra = {
        6, {{0, 1, 3, 7}, {0, 5, 1, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 6, 4, 7}}};
    if (kind == ELEMENT_WEDGE6) return wedges;
    return kind == ELEMENT_TET4 || kind == ELEMENT_TET10 ? tetrahedra : cell;
}

// Nodes of order 2 stand half way: all are on a lattice of half cells.
typedef struct SpaceLattice {
    int32_t points[3];
    double (*place)[3];
    int32_t *node;   // -1: none
} SpaceLattice;

static inline int32_t lattice_at(const SpaceLattice *lattice, const int32_t *at)
{
    return at[0] + lattice->points[0] * (at[1] + lattice->points[1] * at[2]);
}

static inline void space_place(const SpaceDef *def, SpaceLattice *lattice)
{
    Random random = {.state = def->seed};
    int32_t at[3], corner[3];
    for (at[2] = 0; at[2] < lattice->points[2]; at[2] += 2)
        for (at[1] = 0; at[1] < lattice->points[1]; at[1] += 2)
            for (at[0] = 0; at[0] < lattice->points[0]; at[0] += 2) {
                bool inside = true;
                for (int d = 0; d < 3; d++)
                    inside = inside && at[d] > 0 && at[d] < lattice->points[d] - 1;
                double move = inside ? def->distortion : 0;
                for (int d = 0; d < 3; d++)
                    lattice->place[lattice_at(lattice, at)][d] =
                        def->size[d] / def->cells[d] *
                        (at[d] / 2 + random_between(&random, -move, move));
            }
    // The mean of the corners around; on a diagonal of tetrahedra, of its two ends.
    bool ends = def->kind == ELEMENT_TET10;
    for (at[2] = 0; at[2] < lattice->points[2]; at[2]++)
        for (at[1] = 0; at[1] < lattice->points[1]; at[1]++)
            for (at[0] = 0; at[0] < lattice->points[0]; at[0]++) {
                int32_t odd = at[0] % 2 + 2 * (at[1] % 2) + 4 * (at[2] % 2);
                double sum[3] = {0};
                int32_t count = 0;
                if (odd == 0) continue;
                for (int32_t k = 0; k < 8; k++) {
                    if ((k & ~odd) || (ends && k != 0 && k != odd)) continue;
                    for (int d = 0; d < 3; d++)
                        corner[d] = at[d] + ((odd >> d) & 1) * (2 * ((k >> d) & 1) - 1);
                    const double *from = lattice->place[lattice_at(lattice, corner)];
                    for (int d = 0; d < 3; d++) sum[d] += from[d];
                    count++;
                }
                for (int d = 0; d < 3; d++)
                    lattice->place[lattice_at(lattice, at)][d] = sum[d] / count;
            }
}

#endif
