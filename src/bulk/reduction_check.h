// SPDX-License-Identifier: GPL-2.0-or-later
// How far a reduced bulk can be trusted, measured after the fact on the full mesh: its interface
// operator S(s) against the exact one at shifts s that were not used to build it. A Galerkin
// reduction is too stiff, never too soft, so with S = L L'
//
//     error = largest eigenvalue of L^-1 (S_reduced - S) L^-T  >= 0:
//
// the largest relative error of the resistance v' S v to any motion v of the interface. Called by
// run/model_shape when a basis is made.
#ifndef AMONTONS_BULK_REDUCTION_CHECK_H
#define AMONTONS_BULK_REDUCTION_CHECK_H

#include "bulk/interface_operator.h"

// full, reduced: of the same bulk and interface. error: over all shifts checked.
bool reduction_check(BulkOperator *full, BulkOperator *reduced, double *error, Error *err);

#endif
