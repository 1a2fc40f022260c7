// SPDX-License-Identifier: GPL-2.0-or-later
// The basis of a reduced bulk while it is built: static modes Psi and, of responses X of the full
// mesh, what is left without them,
//
//     Phi = X mix - Psi parts,
//
// so that Phi is 0 on the interface and Psi'K Phi = 0. Phi is not orthogonal in itself before
// reduction/basis_finish makes it so. Filled by reduction/growing_basis.
#ifndef AMONTONS_REDUCTION_BASIS_STATE_H
#define AMONTONS_REDUCTION_BASIS_STATE_H

#include "reduction/responses.h"

typedef struct GrowingBasis {
    int32_t full_dofs, interface_count, interior_count;   // m, r
    Responses responses;   // the first m of them are Psi; owned, like all below
    double loss_max;   // of digits, from which on new modes are multiplied by the mesh
    double *statics[BULK_TERMS];   // [m^2] Psi' (K, C, M) Psi
    double *beside[BULK_TERMS];   // [m * r] Psi' (C, M) Phi; none of K
    double *interior[BULK_TERMS];   // [r^2] Phi' (K, C, M) Phi, both triangles
    double *lower;   // [r^2] Cholesky factor of that of K
    double *load;   // [m + r] f' (Psi, Phi), f the unit load
    double *parts;   // [m * r]
    double *mix;   // [(responses.count - m) * r]; NULL: the unit matrix
} GrowingBasis;

#endif
