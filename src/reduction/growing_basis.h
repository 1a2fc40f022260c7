// SPDX-License-Identifier: GPL-2.0-or-later
// How a basis begins and what each block of responses adds to it. Called by reduction/reduction.
#ifndef AMONTONS_REDUCTION_GROWING_BASIS_H
#define AMONTONS_REDUCTION_GROWING_BASIS_H

#include "reduction/basis_state.h"

// full: the mesh's, which must outlive the basis. basis_start fills it first.
bool basis_create(const BulkOperator *full, const BulkScales *scales, GrowingBasis *basis,
                  Error *err);
void basis_destroy(GrowingBasis *basis);

// Static modes, and the static response to the load. statics: the full mesh at K alone.
bool basis_start(GrowingBasis *basis, InterfaceOperator *statics, Error *err);

// Adds what the next block of responses has beside all modes.
bool basis_extend(GrowingBasis *basis, Error *err);

#endif
