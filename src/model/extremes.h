// SPDX-License-Identifier: GPL-2.0-or-later
// Where rounding leaves nothing of a reduction: which numbers of the scene are too far apart.
// Called by model/obtain.
#ifndef AMONTONS_MODEL_EXTREMES_H
#define AMONTONS_MODEL_EXTREMES_H

#include "model/model.h"

// After a reduction that failed with `err`. Under reduction.use: auto an error of computing is
// taken back (true), and model->not_reduced says why the whole mesh is stepped: the largest
// quotient of the block's numbers, where one is unusual. Under `always` the error names its key.
// Other errors, such as lack of memory, stay: bits must not depend on them.
bool model_blame_extremes(Model *model, Error *err);

#endif
