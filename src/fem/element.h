// SPDX-License-Identifier: GPL-2.0-or-later
// Matrices of one element: K = int B' D_el B, C = int B' D_vis B, and a lumped mass that is
// positive at every node. Used by fem/element_group and fem/recovery.
#ifndef AMONTONS_FEM_ELEMENT_H
#define AMONTONS_FEM_ELEMENT_H

#include "fem/material.h"
#include "io/mesh/shape_functions.h"

enum { ELEMENT_DOFS_MAX = DIM_MAX * ELEMENT_NODES_MAX };

// In the plane forces and masses are per width, and areas areas; in space there is no width, and
// areas are volumes. Entries beyond dof_count are not set.
typedef struct ElementMatrices {
    int32_t dof_count;   // dim * nodes: x to z of each in turn
    double stiffness[ELEMENT_DOFS_MAX][ELEMENT_DOFS_MAX];   // force/width per length
    double damping[ELEMENT_DOFS_MAX][ELEMENT_DOFS_MAX];   // force/width per velocity
    double mass[ELEMENT_NODES_MAX];   // mass/width of each node
    double areal[ELEMENT_DOFS_MAX];   // int (N_a,x to N_a,z): by u the growth of the area, length
    double area;
} ElementMatrices;

// position: [nodes]. Mass is lumped in proportion to int N_a^2, keeping the total: on T3 and on
// parallelograms Q4 this is the row sum. with_areal false: K and C are of the strain less its areal
// part (in space that of volume), which fem/element_group adds as a mean.
void element_matrices(ElementKind kind, const MeshPlace *position, const Material *material,
                      bool with_areal, ElementMatrices *out);

// All zero, for as many unknowns.
void element_matrices_clear(int32_t dof_count, ElementMatrices *out);

// B at one point: strain = B [strains][dofs] u; returns det J.
double element_strain_matrix(ElementKind kind, const MeshPlace *position, const double *point,
                             double b[STRAINS_MAX][ELEMENT_DOFS_MAX]);

#endif
