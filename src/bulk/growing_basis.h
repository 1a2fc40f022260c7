// SPDX-License-Identifier: GPL-2.0-or-later
// The basis of a reduced bulk while it is built. Static modes Psi and Phi orthonormal in K give M,
// C, K the form of bulk/reduced_bulk at every moment. Used by bulk/reduction alone.
#ifndef AMONTONS_BULK_GROWING_BASIS_H
#define AMONTONS_BULK_GROWING_BASIS_H

#include "bulk/interface_operator.h"

typedef struct GrowingBasis {
    ReducedBulk *reduced;   // not owned
    BulkOperator full;   // of the mesh
    int32_t modes_room;   // columns that reduced->modes has room for
    double *border;   // [interface] work
    double *still;   // [interface] zeros: the interface at rest
    double *zeros, *unit_load;   // [dofs]
} GrowingBasis;

// reduced: zeroed but for its scales; stays the caller's. basis_start fills it first.
bool basis_create(const Bulk *bulk, const int32_t *interface_dofs, int32_t interface_count,
                  ReducedBulk *reduced, GrowingBasis *basis, Error *err);
void basis_destroy(GrowingBasis *basis);   // all but `reduced`

// Static modes, and the static answer to the load. statics: the full mesh at K alone.
bool basis_start(GrowingBasis *basis, InterfaceOperator *statics, Error *err);

// Room behind the modes for `columns` answers of the full mesh, [dofs * columns]. basis_extend then
// adds their part that is K-orthogonal to all modes to Phi, orthonormal in K. NULL: no memory.
double *basis_make_room(GrowingBasis *basis, int32_t columns, Error *err);
bool basis_extend(GrowingBasis *basis, int32_t columns, Error *err);

// The basis's own answers with A the sum of factor[term] times K/E, C/eta, M/(rho L^2): schur
// [interface^2], and the energy of that to the unit load, the interface at rest.
bool basis_condense(const GrowingBasis *basis, const double *factor, double *schur, double *energy,
                    Error *err);

// y = K x / E, C x / eta or M x / (rho L^2) on the full mesh; [dofs].
void basis_apply_full(const GrowingBasis *basis, BulkTerm term, const double *x, double *y);

#endif
