// SPDX-License-Identifier: GPL-2.0-or-later
// Forces of the whole block in the model's own terms. In the plane forces are per width of the
// block, so those that a scene gives in newtons are divided by its `thickness`; in space they are
// what they are. The pressure of a force needs the top of the mesh. Called by model/assemble and
// study/line.
#ifndef AMONTONS_MODEL_LOADS_H
#define AMONTONS_MODEL_LOADS_H

#include "fem/mesh.h"
#include "scene/scene.h"

// ERROR_INPUT: the scene gives forces of the whole block and, in the plane, no thickness; or a
// thickness of a block in space.
bool scene_check_thickness(const Scene *scene, const Mesh *mesh, Error *err);

// Pressure on groups.top: load.pressure, or load.force over the area of the top, stress.
bool scene_pressure(const Scene *scene, const Mesh *mesh, double *pressure, Error *err);

// Traction number k of the scene along each axis, stress: a force is spread over its group.
bool scene_traction(const Scene *scene, const Mesh *mesh, int32_t k, MeshPlace traction,
                    Error *err);

// Stiffness of the machine, in the plane force/width over length, in space force over length; 0:
// the rod is rigid. breadth: of a block in space, 1 in the plane.
double scene_machine_stiffness(const Scene *scene, const Mesh *mesh, double breadth);

// Forces of the whole block over those of the model: thickness, in space 1; NaN: not known.
double scene_whole_force(const Scene *scene, int32_t dim);

#endif
