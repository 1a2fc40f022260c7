// SPDX-License-Identifier: GPL-2.0-or-later
// The basis of a reduced bulk while it is built: static modes Psi and, of answers X of the full
// mesh, what is left without them,
//
//     Phi = X mix - Psi parts,
//
// so that Phi is 0 on the interface and Psi'K Phi = 0. Phi is not orthogonal in itself before
// basis_finish makes it so. Used by bulk/reduction, bulk/basis_condense and bulk/basis_finish alone.
#ifndef AMONTONS_BULK_GROWING_BASIS_H
#define AMONTONS_BULK_GROWING_BASIS_H

#include "bulk/answers.h"

typedef struct GrowingBasis {
    int32_t full_dofs, interface_count, interior_count;   // m, r
    Answers answers;   // the first m of them are Psi; owned, like all below
    double loss_max;   // of digits, from which on new modes are multiplied by the mesh
    double *statics[BULK_TERMS];   // [m^2] Psi' (K, C, M) Psi
    double *beside[BULK_TERMS];   // [m * r] Psi' (C, M) Phi; none of K
    double *interior[BULK_TERMS];   // [r^2] Phi' (K, C, M) Phi, both triangles
    double *lower;   // [r^2] Cholesky factor of that of K
    double *load;   // [m + r] f' (Psi, Phi), f the unit load
    double *parts;   // [m * r]
    double *mix;   // [(answers.count - m) * r]; NULL: the unit matrix
} GrowingBasis;

// full: the mesh's, which must outlive the basis. basis_start fills it first.
bool basis_create(const BulkOperator *full, const BulkScales *scales, GrowingBasis *basis,
                  Error *err);
void basis_destroy(GrowingBasis *basis);

// Static modes, and the static answer to the load. statics: the full mesh at K alone.
bool basis_start(GrowingBasis *basis, InterfaceOperator *statics, Error *err);

// Adds what the next block of answers has beside all modes.
bool basis_extend(GrowingBasis *basis, Error *err);

// Makes Phi from column `first` on orthonormal in K and orthogonal to those before, and multiplies
// it by the mesh: rounding that products of answers brought in goes.
bool basis_renew(GrowingBasis *basis, int32_t first, Error *err);

// Columns of Phi turn, `turn` [r * columns], into `field` [full_dofs * columns], zero before.
bool basis_form(const GrowingBasis *basis, const double *turn, int64_t columns, double *field,
                Error *err);

#endif
