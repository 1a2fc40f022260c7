// SPDX-License-Identifier: GPL-2.0-or-later
// Which element is made of which material: the physical surfaces that the map `materials` of a
// scene names. Called by model/assemble when the mesh is there, and when the interface is.
#ifndef AMONTONS_MODEL_REGIONS_H
#define AMONTONS_MODEL_REGIONS_H

#include "model/model.h"

// Marks the elements of model->mesh with their materials and measures these; groups those that are
// nearly incompressible (fem/element_group). ERROR_INPUT: no such surface, or two that share an
// element.
bool model_mark_regions(Model *model, Error *err);

// Sets the materials that the contact and the ends of the rod's strip, from low to high, lie on.
bool model_place_regions(Model *model, double low, double high, Error *err);

// Fills the bulk's spectrum. What relaxes so fast that not even waves within an element follow is
// made a viscosity (model->folded_time).
bool model_lay_branches(Model *model, Error *err);

#endif
