// SPDX-License-Identifier: GPL-2.0-or-later
// The interface operator S as the nodes that touch see it. Open nodes O bear no force: what they do
// follows from the others, and
//
//     S' = S - S_.O S_OO^-1 S_O.
//
// is all that the others meet. Blocks on pads have most of their nodes open while few slip, and a
// node that opens or closes changes S' by two sweeps (base/dense), which cost as much as a few
// products with S; factoring S_OO in every system costs far more. Operators are kept swept: those
// of the rungs in use. Called by contact/contact_solver and stepping/certificate.
#ifndef AMONTONS_CONTACT_CLOSED_OPERATOR_H
#define AMONTONS_CONTACT_CLOSED_OPERATOR_H

#include "contact/contact_problem.h"

enum { CLOSED_OPERATORS_MAX = 48, CLOSED_OPERATORS_MIN = 3 };   // kept, within some memory

typedef struct SweptOperator {
    const double *schur;   // S it was copied from; NULL: none. Not owned
    double *matrix;   // [count^2] swept on `out`, both triangles; owned
    uint8_t *out;   // [contact_count] 1: both unknowns of the node are swept; owned
    int32_t sweeps;   // since it was copied
    int64_t used;   // when it was asked for last
} SweptOperator;

typedef struct ClosedOperator {
    int32_t count, contact_count, kept_count;
    SweptOperator kept[CLOSED_OPERATORS_MAX];
    double *work;   // [count]; owned
    int64_t clock, sweeps;   // requests and sweeps, counted
} ClosedOperator;

bool closed_operator_create(const Interface *interface, ClosedOperator *closed, Error *err);
void closed_operator_destroy(ClosedOperator *closed);

// `schur` [count^2] swept on the tangents and normals of the nodes that `status` [contact_count]
// has open, and on nothing else: itself where none is. Belongs to `closed`, and stands until the
// same `schur` is asked for with other statuses, or CLOSED_OPERATORS_MIN others are. NULL: S_OO is
// nearly singular, what is open floats. A `schur` at the same address is taken for the same.
const double *closed_operator_of(ClosedOperator *closed, const double *schur,
                                 const uint8_t *status);

#endif
