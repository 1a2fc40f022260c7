// SPDX-License-Identifier: GPL-2.0-or-later
// Strains and stresses at the nodes: the mean over the elements around a node. Called by
// record/fields, on demand only.
#ifndef AMONTONS_BULK_RECOVERY_H
#define AMONTONS_BULK_RECOVERY_H

#include "bulk/material.h"
#include "bulk/mesh.h"

// Components in the order xx, zz, xz.
typedef struct NodalStress {
    double *elastic;   // [node_count * 3] stress; owned
    double *total;   // [node_count * 3] elastic and viscous, stress; owned
    double *von_mises;   // [node_count] of the total stress, stress; owned
    int32_t *shares;   // [node_count] work: elements that met at the node; owned
    int32_t node_count;
} NodalStress;

bool nodal_stress_create(const Mesh *mesh, NodalStress *stress, Error *err);
void nodal_stress_destroy(NodalStress *stress);

// displacement, velocity: [2 * node_count]
void nodal_stress_recover(const Mesh *mesh, const Material *materials, const double *displacement,
                          const double *velocity, NodalStress *stress);

#endif
