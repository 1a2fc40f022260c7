// SPDX-License-Identifier: GPL-2.0-or-later
// gmsh in a process of its own (base/apart), so that a mesh that crashes it is an error like any
// other. Called by io/mesh/mesh_read.
#ifndef AMONTONS_IO_MESH_MESH_APART_H
#define AMONTONS_IO_MESH_MESH_APART_H

#include "io/mesh/mesh_raw.h"

// The mesh, in this process where apart is not wanted. The module is opened in this process, once
// for all meshes: to load it takes a tenth of a second, to hand it on to a child some milliseconds.
bool mesh_apart_read(const MeshRawRequest *request, MeshFile *mesh, Error *err);

#endif
