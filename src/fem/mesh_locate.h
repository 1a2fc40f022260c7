// SPDX-License-Identifier: GPL-2.0-or-later
// Which element a place lies in, and where in it. Used by fem/mesh_build and model/obtain.
#ifndef AMONTONS_FEM_MESH_LOCATE_H
#define AMONTONS_FEM_MESH_LOCATE_H

#include "fem/mesh_faces.h"

// The element that `place` lies in, that of the block before that of the base, of several the
// first; at: where in it, as reference coordinates. -1: none of the mesh.
int32_t mesh_locate(const Mesh *mesh, const double *place, MeshPlace at);

// The node nearest to `place`; distance: how far away it is, length.
int32_t mesh_nearest_node(const Mesh *mesh, const double *place, double *distance);

// Checks that faces on one element alone are the block's surface. ERROR_INPUT, with the place and
// both elements: one of them has another element right behind it, as at the nodes of a crack that
// are there twice, beside a hanging node, and where elements overlap. faces: those of the mesh.
bool mesh_check_inside(const Mesh *mesh, const MeshFaces *faces, Error *err);

#endif
