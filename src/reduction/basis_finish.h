// SPDX-License-Identifier: GPL-2.0-or-later
// A basis that is built becomes a part of a reduced bulk. Called by reduction/reduction.
#ifndef AMONTONS_REDUCTION_BASIS_FINISH_H
#define AMONTONS_REDUCTION_BASIS_FINISH_H

#include "reduction/basis_state.h"

// Fills matrices, load and sizes of `part`, its modes where they are wanted. Turns Phi so that
// its K is the unit matrix and its M tridiagonal; `basis` is of no use any more.
bool basis_finish(GrowingBasis *basis, bool modes, ReducedPart *part, Error *err);

#endif
