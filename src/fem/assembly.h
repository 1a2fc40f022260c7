// SPDX-License-Identifier: GPL-2.0-or-later
// The semi-discrete bulk M u'' + C u' + K u = f: sparse K and C on one pattern, lumped M, loads.
// Branches of materials (fem/spectrum) have matrices of their own on that pattern.
// Unknowns: node_dof(dim, node, d) is the displacement along axis d; of a contact node over a floor
// that deforms its jump against the floor (fem/floor).
#ifndef AMONTONS_FEM_ASSEMBLY_H
#define AMONTONS_FEM_ASSEMBLY_H

#include "algebra/sparse.h"
#include "fem/material.h"
#include "fem/mesh.h"
#include "fem/spectrum.h"

typedef struct Bulk {
    int32_t dim;   // unknowns of a node
    int32_t dof_count;   // dim * nodes
    double *load;   // [dof_count] f, force/width; starts at 0; owned
    double *place;   // [3 * dof_count] coordinates of each unknown, in space, where they order the
        // factor; NULL in the plane; owned
    uint8_t *held;   // [dof_count] 1: stays at 0 (bulk_hold); owned
    SparsePattern pattern;   // of K and C, empty before bulk_assemble; owned
    double *stiffness;   // [pattern.start[dof_count]]; owned
    double *damping;   // same; owned
    double *mass;   // [dof_count] lumped, all directions alike; the diagonal of M; owned
    double *mass_beside;   // [pattern.start[dof_count]] M beside its diagonal, as where contact
        // nodes move with the floor (fem/floor); NULL: nothing; owned
    uint8_t *in_base;   // [dof_count] 1: of the base; NULL: there is none; owned
    Spectrum spectrum;   // of the materials' branches; set before bulk_assemble
    double *shape[SPECTRUM_SHAPES_MAX];   // [spectrum.matrix_count][entries] S_j; owned
    double area;   // of the block, length^2; in space its volume
} Bulk;

// Creates it without loads and supports, and without matrices.
bool bulk_create(const Mesh *mesh, Bulk *bulk, Error *err);
// y = M x; [dof_count]
void bulk_apply_mass(const Bulk *bulk, const double *x, double *y);

// Fills pattern, K, C, M and the shape matrices of bulk->spectrum. materials: one, or as many as
// the mesh has regions, by their numbers.
bool bulk_assemble(const Mesh *mesh, const Material *materials, Bulk *bulk, Error *err);
void bulk_destroy(Bulk *bulk);

// load += int N_a traction dA, traction: [dim]. A pressure P on top is (0, -P).
void bulk_add_traction(const Mesh *mesh, const MeshBoundary *boundary, const double *traction,
                       Bulk *bulk);

// Holds an unknown at 0: its couplings in K, C and S_j and its load become 0, its mass and diagonal
// entries stay.
void bulk_hold(int32_t dof, Bulk *bulk);

// The weights of a boundary's nodes, int N_a dA; of its shadow on the floor: int N_a dx, in space
// dx dy; added to weight[node]; [mesh->node_count].
void boundary_add_weights(const Mesh *mesh, const MeshBoundary *boundary, bool shadow,
                          double *weight);

#endif
