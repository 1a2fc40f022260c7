// SPDX-License-Identifier: GPL-2.0-or-later
// The border between bulk and time stepper. The stepper sees a linear system with `dof_count`
// unknowns of which a few, the interface, carry unknown reactions:
//
//     M u'' + C u' + K u = f + G' r
//
// and asks for A = m M + c C + k K condensed on the interface, S v_b = g + r_b, and for v from v_b.
// Here the unknowns are those of the full mesh and A is factored by CHOLMOD with the interface
// last; a reduced bulk fills the same struct with dense matrices.
#ifndef AMONTONS_BULK_INTERFACE_OPERATOR_H
#define AMONTONS_BULK_INTERFACE_OPERATOR_H

#include "bulk/assembly.h"

typedef enum BulkTerm { BULK_STIFFNESS, BULK_DAMPING } BulkTerm;

typedef struct BulkOperator {
    int32_t dof_count;
    int32_t interface_count;
    int32_t *interface_dofs;   // [interface_count] indices of unknowns; owned
    const Bulk *bulk;   // K, C, M, f; not owned
    SparseAnalysis *analysis;   // owned
    double *values;   // [entries] work: A; owned
    int64_t factorisations;   // counted
    int64_t solves;   // counted
} BulkOperator;

// `bulk` must outlive the operator.
bool bulk_operator_create(const Bulk *bulk, const int32_t *interface_dofs, int32_t interface_count,
                          BulkOperator *system, Error *err);
void bulk_operator_destroy(BulkOperator *system);

// y = K x or C x; [dof_count]
void bulk_operator_apply(const BulkOperator *system, BulkTerm term, const double *x, double *y);

typedef struct OperatorTerms {
    double mass, damping, stiffness;   // factors of M, C, K in A
    double shift;   // added to A's interface diagonal before factoring and taken
        // off S afterwards: lets C alone, which is singular, be used
} OperatorTerms;

typedef struct InterfaceOperator InterfaceOperator;   // A, factored

// ERROR_COMPUTE when A is not positive definite.
InterfaceOperator *interface_operator_create(BulkOperator *system, OperatorTerms terms, Error *err);
void interface_operator_destroy(InterfaceOperator *condensed);   // NULL is fine

// S: [interface_count^2], symmetric, column-major.
const double *interface_operator_schur(const InterfaceOperator *condensed);
// rhs [dof_count] -> g [interface_count]; expand must follow before the next condense.
bool interface_operator_condense(InterfaceOperator *condensed, const double *rhs, double *g,
                                 Error *err);
// v_b [interface_count] -> v [dof_count]
bool interface_operator_expand(InterfaceOperator *condensed, const double *interface, double *v,
                               Error *err);

#endif
