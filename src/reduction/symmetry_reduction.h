// SPDX-License-Identifier: GPL-2.0-or-later
// A block's reduced bulk: it is reduced as it is or, where it is its own mirror image, as two parts
// (reduction/mirror), each for itself (reduction/reduction). What is taken out of the border
// afterwards makes no error larger: it is below the larger of the parts'. Called by model/obtain.
#ifndef AMONTONS_REDUCTION_SYMMETRY_REDUCTION_H
#define AMONTONS_REDUCTION_SYMMETRY_REDUCTION_H

#include "reduction/reduction.h"

// interface_dofs: [m] unknowns of `bulk`.
bool symmetry_reduction_build(const Bulk *bulk, const int32_t *interface_dofs, int32_t m,
                              const ReductionDef *def, ReducedBulk *reduced, Error *err);

#endif
