// SPDX-License-Identifier: GPL-2.0-or-later
// Which of the bulk's matrices is meant, and A = m M + c C + k K. Used by
// reduction/interface_operator and what is behind it.
#ifndef AMONTONS_REDUCTION_OPERATOR_TERMS_H
#define AMONTONS_REDUCTION_OPERATOR_TERMS_H

#include <stdbool.h>

typedef enum BulkTerm { BULK_STIFFNESS, BULK_DAMPING, BULK_MASS } BulkTerm;
enum { BULK_TERMS = BULK_MASS + 1 };

typedef struct OperatorTerms {
    double mass, damping, stiffness;   // factors of M, C, K in A
    bool lift;   // A may be singular in the interface's own motion (C or K alone): its interface
        // diagonal is raised to factor it, and S lowered again
    bool lower_only;   // of a mesh: S will not be asked for, its Cholesky factor may be
} OperatorTerms;

#endif
