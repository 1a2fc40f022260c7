// SPDX-License-Identifier: GPL-2.0-or-later
// The mesh that a scene asks for: read, its block picked, checked, scaled, moved. Used by
// model/assemble, run/info and study/line, so that all see the same block.
#ifndef AMONTONS_MODEL_SCENE_MESH_H
#define AMONTONS_MODEL_SCENE_MESH_H

#include "fem/mesh.h"
#include "scene/scene.h"

// *mesh is the caller's to destroy, also on failure. origin: NULL where nobody asks. Errors name
// the key of the scene that is wrong.
bool scene_mesh_read(const Scene *scene, const ChildWatch *watch, Mesh *mesh, MeshOrigin *origin,
                     Error *err);

#endif
