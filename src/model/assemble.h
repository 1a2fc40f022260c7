// SPDX-License-Identifier: GPL-2.0-or-later
// From a scene to the block: mesh, loads, interface, supports. Called by model/obtain and by
// run/static/static_solve, which have its matrices assembled where they need them.
#ifndef AMONTONS_MODEL_ASSEMBLE_H
#define AMONTONS_MODEL_ASSEMBLE_H

#include "model/model.h"

// Each needs the ones before it; the first an empty model (model_of).
bool model_read_mesh(const ChildWatch *watch, Model *model, Error *err);
bool model_lay_bulk(Model *model, Error *err);   // the bulk's loads, and the interface
// Holds the unknowns of supports. ERROR_INPUT: a group is not there, or the base can move freely.
bool model_hold_supports(Model *model, Error *err);

// The stress the loads are measured with.
double load_reference(const Model *model);

#endif
