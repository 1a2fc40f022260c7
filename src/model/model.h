// SPDX-License-Identifier: GPL-2.0-or-later
// From a scene to the parts that step: mesh, material, law, operators, step control. The one place
// that translates the scene's words into the definitions of the layers below.
#ifndef AMONTONS_MODEL_MODEL_H
#define AMONTONS_MODEL_MODEL_H

#include "run/simulation.h"

// model/model_shape: everything up to the operator, the shortest way. What the scene does not need
// of it is not done: a shape in the cache is neither meshed nor assembled.
bool model_obtain(Simulation *simulation, Error *err);

// Parts of that, for those who need the assembled bulk itself; each needs the ones before it.
bool model_read_mesh(Simulation *simulation, Error *err);
bool model_build_bulk(Simulation *simulation, Error *err);   // material, bulk, loads, interface
bool model_hold_supports(Simulation *simulation, Error *err);   // takes their unknowns out of it

// model/model: the rod at rest, `kind` for now, with the springs of its ends; needs the interface.
bool model_build_rod(Simulation *simulation, RodKind kind, Error *err);

// model/model: after model_obtain, in this order.
bool model_prepare_steps(Simulation *simulation, Error *err);
bool model_relax(Simulation *simulation, Error *err);   // to t = 0, the rod in place

// Where the rod touches a block of this height: the centre of its strip over the plane and its
// extent, length.
void model_rod_strip(const Scene *scene, double height, double *middle, double *width);

#endif
