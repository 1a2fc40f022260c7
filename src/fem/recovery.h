// SPDX-License-Identifier: GPL-2.0-or-later
// Strains and stresses at the nodes: the mean over the elements around a node. Called by
// record/field_files, record/probes and run/static/static_solve.
#ifndef AMONTONS_FEM_RECOVERY_H
#define AMONTONS_FEM_RECOVERY_H

#include "fem/material.h"
#include "fem/mesh.h"
#include "fem/spectrum.h"

// Components in the order xx, zz, xz; in space xx, yy, zz, xy, yz, xz. Where materials meet, stress
// jumps: a node there is a point in each of them. The first points are the nodes of the mesh, each
// with the lowest number of its materials; the others follow.
typedef struct NodalStress {
    double *elastic;   // [point_count * strain_count(dim)] of all springs, stress; owned
    double *total;   // [point_count * strain_count(dim)] elastic and viscous, stress; owned
    double *von_mises;   // [point_count] of the total stress, stress; owned
    int32_t *row, *row_length;   // [point_count] where a point's row of the operator begins; owned
    int32_t *column;   // a row's nodes, and at each:
    MeshPlace *slope;   // d/dx to d/dz of shape functions, means over the point's elements; owned
    MeshPlace *areal;   // by u what the areal strain is above that of the slopes, where elements
        // share one; owned; NULL: none do
    int32_t dim;
    int32_t point_count;   // from the mesh's nodes on
    int32_t *points;   // [mesh->first_node[elements]] in the place of element_nodes; owned; NULL:
        // points are nodes
    int32_t *region;   // [point_count] number of the point's material; owned; NULL: one material
    int32_t *extra_node;   // [point_count - nodes] of the points that follow; owned
} NodalStress;

// The points of an element: [its nodes].
const int32_t *nodal_stress_points(const NodalStress *stress, const Mesh *mesh, int32_t e);

bool nodal_stress_create(const Mesh *mesh, NodalStress *stress, Error *err);
void nodal_stress_destroy(NodalStress *stress);

// Adds to row [dim * node_count] `share` times the coefficients of the displacements in component
// `component` of the strain at `point`, a shear as the engineering one.
void nodal_strain_row(const NodalStress *stress, int32_t point, int32_t component, double share,
                      double *row);

// displacement, velocity: [dim * node_count]. relaxing: [spectrum->shape_count] likewise, what the
// materials' branches are stretched by, sum_k g_kj e_k of each shape (fem/spectrum), stress *
// length; NULL: none is stretched.
void nodal_stress_recover(const Material *materials, const double *displacement,
                          const double *velocity, const Spectrum *spectrum,
                          const double *const *relaxing, NodalStress *stress);

#endif
