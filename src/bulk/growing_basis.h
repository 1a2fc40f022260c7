// SPDX-License-Identifier: GPL-2.0-or-later
// The basis of a reduced bulk while it is built, out of answers of the full mesh. Static modes Psi
// and Phi orthonormal in K give M, C, K the form of bulk/reduced_bulk at every moment. Used by
// bulk/reduction alone.
#ifndef AMONTONS_BULK_GROWING_BASIS_H
#define AMONTONS_BULK_GROWING_BASIS_H

#include "bulk/answers.h"

typedef struct GrowingBasis {
    ReducedBulk *reduced;   // not owned; its modes come last
    Answers answers;   // owned
    double loss_max;   // of digits, from which on new modes are multiplied by the mesh
    double *mix;   // [answers.count * reduced->count] modes = answers * mix; owned
} GrowingBasis;

// full: the mesh's, which must outlive the basis. reduced: zeroed but for its scales; stays the
// caller's. basis_start fills it first.
bool basis_create(const BulkOperator *full, ReducedBulk *reduced, GrowingBasis *basis, Error *err);
void basis_destroy(GrowingBasis *basis);   // all but `reduced`

// Static modes, and the static answer to the load. statics: the full mesh at K alone.
bool basis_start(GrowingBasis *basis, InterfaceOperator *statics, Error *err);

// Adds what of the next block of answers is K-orthogonal to all modes to Phi, orthonormal in K.
bool basis_extend(GrowingBasis *basis, Error *err);

// Multiplies modes from `first` on (not the static ones) by the mesh and makes them orthonormal
// again: rounding that products of answers brought in goes.
bool basis_renew(GrowingBasis *basis, int32_t first, Error *err);

// Fills reduced->modes, [dofs * count].
bool basis_write_modes(GrowingBasis *basis, Error *err);

#endif
