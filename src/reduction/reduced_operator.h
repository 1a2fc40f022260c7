// SPDX-License-Identifier: GPL-2.0-or-later
// Products of a reduced bulk in a scene's units, and its A condensed on the interface.
// It does so part by part, with work that all it made share: not from two threads at once. Called
// by reduction/interface_operator.
#ifndef AMONTONS_REDUCTION_REDUCED_OPERATOR_H
#define AMONTONS_REDUCTION_REDUCED_OPERATOR_H

#include "fem/spectrum.h"
#include "reduction/reduced_bulk.h"

// BULK_SHAPE + j is the shape matrix S_j, which may be K.
typedef enum BulkTerm { BULK_STIFFNESS, BULK_DAMPING, BULK_MASS, BULK_SHAPE } BulkTerm;

static inline BulkTerm bulk_shape(int32_t j)
{
    return (BulkTerm)(BULK_SHAPE + j);
}

enum { BULK_TERMS = BULK_SHAPE, BULK_TERMS_MAX = BULK_SHAPE + SPECTRUM_SHAPES_MAX };

// A = m M + c C + k K, with what branches of the materials add to it:
// sum_k k s tau_k/(1 + s tau_k) K_k at the rate s = c/k (fem/spectrum).
typedef struct OperatorTerms {
    double mass, damping, stiffness;   // factors of M, C, K in A
    bool lift;   // A may be singular in the interface's own motion (C or K alone): its interface
        // diagonal is raised to factor it, and S lowered again
    bool lower_only;   // of a mesh: S will not be asked for, its Cholesky factor may be
} OperatorTerms;

typedef struct ReducedOperator ReducedOperator;
// `reduced` must outlive it.
ReducedOperator *reduced_operator_create(const ReducedBulk *reduced, Error *err);
void reduced_operator_destroy(ReducedOperator *system);   // NULL is fine

// y = K x, C x, M x or S_j x, [count] each, distinct.
void reduced_operator_apply(const ReducedOperator *system, BulkTerm term, const double *x,
                            double *y);

// out [count] := what x [count] has in those parts of the bulk that are kept; distinct.
void reduced_operator_keep(const ReducedOperator *system, const bool *kept, const double *x,
                           double *out);
// The largest entry that x [count] has in the other parts, over its largest in all; 0 for x = 0.
double reduced_operator_share_beside(const ReducedOperator *system, const bool *kept,
                                     const double *x);
// From here on the other parts are at rest and nothing pushes them, whatever is asked of the
// operator or of what is condensed from it: no product with them is made. NULL: all are kept.
void reduced_operator_rest(ReducedOperator *system, const bool *kept);

// A of one set of terms, condensed.
typedef struct CondensedBulk CondensedBulk;
// Fills schur [interface_count^2].
CondensedBulk *condensed_bulk_create(const ReducedOperator *system, OperatorTerms terms,
                                     double *schur, Error *err);
void condensed_bulk_destroy(CondensedBulk *condensed);   // NULL is fine
// rhs [count] -> g [interface_count]; what is inside is kept for the expand that follows.
void condensed_bulk_condense(CondensedBulk *condensed, const double *rhs, double *g);
// v_b [interface_count] -> v [count]
void condensed_bulk_expand(CondensedBulk *condensed, const double *interface, double *v);

#endif
