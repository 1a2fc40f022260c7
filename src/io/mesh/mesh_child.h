// SPDX-License-Identifier: GPL-2.0-or-later
// gmsh in a child process (base/child_process), so that a mesh that crashes it is an error like any
// other. Called by io/mesh/mesh_read.
#ifndef AMONTONS_IO_MESH_MESH_CHILD_H
#define AMONTONS_IO_MESH_MESH_CHILD_H

#include "base/child_process.h"
#include "io/mesh/mesh_raw.h"

// The mesh, in this process where no child is wanted. The module is opened in this process, once
// for all meshes: to load it takes a tenth of a second, to hand it on to a child some milliseconds.
// watch: may end it; NULL: nobody. In this process nothing ends gmsh.
bool mesh_child_read(const MeshRawRequest *request, const ChildWatch *watch, MeshFile *mesh,
                     Error *err);

#endif
