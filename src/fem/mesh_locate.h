// SPDX-License-Identifier: GPL-2.0-or-later
// Which element a place lies in, and where in it. Used by fem/mesh_inside and model/obtain.
#ifndef AMONTONS_FEM_MESH_LOCATE_H
#define AMONTONS_FEM_MESH_LOCATE_H

#include "fem/mesh.h"

// The box around element e, with room for bent sides: [mesh->dim] each, length.
void mesh_element_box(const Mesh *mesh, int32_t e, MeshPlace low, MeshPlace high);

// True if `place` [mesh->dim] lies in element e or on its border; at: its reference coordinates.
bool mesh_element_holds(const Mesh *mesh, int32_t e, const double *place, MeshPlace at);

// The element that `place` lies in, that of the block before that of the base, of several the
// first; at: where in it, as reference coordinates. -1: none of the mesh.
int32_t mesh_locate(const Mesh *mesh, const double *place, MeshPlace at);

// The node nearest to `place`; distance: how far away it is, length.
int32_t mesh_nearest_node(const Mesh *mesh, const double *place, double *distance);

#endif
