// SPDX-License-Identifier: GPL-2.0-or-later
// The reduced bulk of a block that is its own mirror image: each part is reduced for itself
// (reduction/reduction), S of the border is the sum of theirs, and what is taken out of the border
// afterwards makes no error larger: it is below the larger of both. Called by model/obtain.
#ifndef AMONTONS_REDUCTION_SYMMETRY_REDUCTION_H
#define AMONTONS_REDUCTION_SYMMETRY_REDUCTION_H

#include "reduction/mirror.h"
#include "reduction/reduction.h"

// m: unknowns of the interface. The mirror's maps go into `reduced`.
bool symmetry_reduction_build(Mirror *mirror, int32_t m, const ReductionDef *def,
                              ReducedBulk *reduced, Error *err);

#endif
