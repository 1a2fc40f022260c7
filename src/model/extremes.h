// SPDX-License-Identifier: GPL-2.0-or-later
// Where rounding leaves nothing of a reduction: which numbers of the scene are too far apart.
// Called by model/obtain.
#ifndef AMONTONS_MODEL_EXTREMES_H
#define AMONTONS_MODEL_EXTREMES_H

#include "model/model.h"

// done, or the error names the key of the largest quotient among the block's numbers, and what goes
// without a reduction. Other errors than of computing stay as they are. Returns `done`.
bool model_blame_extremes(const Model *model, bool done, Error *err);

#endif
