// SPDX-License-Identifier: GPL-2.0-or-later
// The shape of the substrate: contact.gap and contact.profile. Called by
// model/obtain and run/static/static_solve when the interface is known.
#ifndef AMONTONS_MODEL_GAPS_H
#define AMONTONS_MODEL_GAPS_H

#include "model/model.h"

// Adds them to the gaps that the mesh's own curves leave; without them the interface stays as it
// is. ERROR_INPUT: a gap that is not finite or negative, with x.
bool model_lay_gaps(Model *model, Error *err);

#endif
