// SPDX-License-Identifier: GPL-2.0-or-later
// Products of a reduced bulk in a scene's units, and its A condensed on the interface.
// It does so part by part, with work that all it made share: not from two threads at once. Called
// by reduction/interface_operator.
#ifndef AMONTONS_REDUCTION_REDUCED_OPERATOR_H
#define AMONTONS_REDUCTION_REDUCED_OPERATOR_H

#include "reduction/operator_terms.h"
#include "reduction/reduced_bulk.h"

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
