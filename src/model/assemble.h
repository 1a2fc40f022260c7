// SPDX-License-Identifier: GPL-2.0-or-later
// From a scene to the assembled block: mesh, bulk, loads, interface, supports. Called by
// model/obtain where the cache does not hold the shape, and by run/static/static_solve.
#ifndef AMONTONS_MODEL_ASSEMBLE_H
#define AMONTONS_MODEL_ASSEMBLE_H

#include "model/model.h"

// Each needs the ones before it; the first an empty model (model_of).
bool model_read_mesh(Model *model, Error *err);
bool model_build_bulk(Model *model, Error *err);   // bulk, loads, interface
bool model_hold_supports(Model *model, Error *err);   // takes their unknowns out of the bulk

// A material in space is neither in plane stress nor in plane strain. ERROR_INPUT: it keeps its
// volume.
bool model_take_to_space(Model *model, Error *err);

double model_memory_there(void);   // of this computer, or what a limit leaves of it, bytes

// The force that others are measured with, from the resultant of the loads towards the plane, per
// unit of load_reference(), wherever that comes from. ERROR_INPUT: nothing presses the block down.
bool model_set_load(Model *model, double unit_resultant, Error *err);

#endif
