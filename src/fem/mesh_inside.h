// SPDX-License-Identifier: GPL-2.0-or-later
// Faces on one element only are the block's surface. Called by fem/mesh_build.
#ifndef AMONTONS_FEM_MESH_INSIDE_H
#define AMONTONS_FEM_MESH_INSIDE_H

#include "fem/mesh_faces.h"

// ERROR_INPUT, with the place and both elements: a face that is on one element alone has another
// one right behind it, as at the nodes of a crack that are there twice, beside a hanging node, and
// where elements overlap. faces: those of the mesh.
bool mesh_check_inside(const Mesh *mesh, const MeshFaces *faces, Error *err);

#endif
