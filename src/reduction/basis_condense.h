// SPDX-License-Identifier: GPL-2.0-or-later
// The response of a basis that is being built. Called by reduction/reduction.
#ifndef AMONTONS_REDUCTION_BASIS_CONDENSE_H
#define AMONTONS_REDUCTION_BASIS_CONDENSE_H

#include "reduction/basis_state.h"

// A is the sum of factor[term], by BulkTerm, times K/E, C/eta, M/(rho L^2). schur [interface^2],
// and the energy of the response to the unit load, the interface at rest. *definite: false, and no
// more, where rounding left A of the interior with a negative eigenvalue.
bool basis_condense(const GrowingBasis *basis, const double *factor, double *schur, double *energy,
                    bool *definite, Error *err);

#endif
