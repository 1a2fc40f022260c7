// SPDX-License-Identifier: GPL-2.0-or-later
// Modes as long as the mesh. Called by reduction/growing_basis, reduction/reduction and
// reduction/basis_finish.
#ifndef AMONTONS_REDUCTION_BASIS_RENEW_H
#define AMONTONS_REDUCTION_BASIS_RENEW_H

#include "reduction/basis_state.h"

// Columns of Phi turn, `turn` [r * columns], into `field` [full_dofs * columns], zero before.
bool basis_form(const GrowingBasis *basis, const double *turn, int64_t columns, double *field,
                Error *err);

// Makes Phi from column `first` on orthonormal in K and orthogonal to those before, and multiplies
// it by the mesh: rounding that products of responses brought in goes.
bool basis_renew(GrowingBasis *basis, int32_t first, Error *err);

#endif
