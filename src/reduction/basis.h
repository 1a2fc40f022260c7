// SPDX-License-Identifier: GPL-2.0-or-later
// The basis of a reduced bulk while it is built: static modes Psi and, of all other responses X of
// the full mesh, what they have beside them,
//
//     Phi = X - Psi X_b,
//
// X_b being X on the interface, so that Phi is 0 there and Psi'K Phi = 0. Phi is not orthogonal in
// itself before basis_finish makes it so. Called by reduction/reduction.
#ifndef AMONTONS_REDUCTION_BASIS_H
#define AMONTONS_REDUCTION_BASIS_H

#include "reduction/responses.h"

typedef struct Basis {
    int32_t full_dofs, interface_count, interior_count;   // m, r
    Responses responses;   // the first m of them are Psi, released; owned, like all below
    double loss_max;   // of digits, from which on a block is made orthonormal
    double *statics[BULK_TERMS_MAX];   // [m^2] Psi' (K, C, M, S_j) Psi
    double *beside[BULK_TERMS_MAX];   // [m * r] Psi' (C, M, S_j) Phi; none of K
    double *interior[BULK_TERMS_MAX];   // [r^2] Phi' (K, C, M, S_j) Phi, both triangles
    double *lower;   // [r^2] Cholesky factor of that of K
    double *load;   // [m + r] f' (Psi, Phi), f the unit load
    double *parts;   // [m * r] X_b
} Basis;

// full: the mesh's, which must outlive the basis. basis_start fills it first.
bool basis_create(const BulkOperator *full, const BulkScales *scales, Basis *basis, Error *err);
void basis_destroy(Basis *basis);

// Static modes, and the static response to the load. statics: the full mesh at K alone, which must
// outlive the basis: it stands for Psi.
bool basis_start(Basis *basis, InterfaceOperator *statics, Error *err);

// Adds what the next block of responses has beside all modes.
bool basis_extend(Basis *basis, Error *err);

// The response to A, the sum of factor[term], by BulkTerm, times K/E, C/eta, M/(rho L^2), S_j:
// schur [interface^2], and the energy of the response to the unit load, the interface at rest.
// *definite: false, and no more, where rounding left A of the interior with a negative eigenvalue.
bool basis_condense(const Basis *basis, const double *factor, double *schur, double *energy,
                    bool *definite, Error *err);

// Fills matrices, load and sizes of `part`, its modes where they are wanted. Turns Phi so that
// its K is the unit matrix and its M diagonal; `basis` is of no use any more.
bool basis_finish(Basis *basis, bool modes, ReducedPart *part, Error *err);

#endif
