// SPDX-License-Identifier: GPL-2.0-or-later
// Which of the bulk's matrices is meant, and A = m M + c C + k K, with what branches of the
// materials add to it: sum_k k s tau_k/(1 + s tau_k) K_k at the rate s = c/k (fem/spectrum). Used
// by reduction/interface_operator and what is behind it.
#ifndef AMONTONS_REDUCTION_OPERATOR_TERMS_H
#define AMONTONS_REDUCTION_OPERATOR_TERMS_H

#include "fem/spectrum.h"

// BULK_SHAPE + j is the shape matrix S_j, which may be K.
typedef enum BulkTerm { BULK_STIFFNESS, BULK_DAMPING, BULK_MASS, BULK_SHAPE } BulkTerm;

static inline BulkTerm bulk_shape(int32_t j)
{
    return (BulkTerm)(BULK_SHAPE + j);
}

enum { BULK_TERMS = BULK_SHAPE, BULK_TERMS_MAX = BULK_SHAPE + SPECTRUM_SHAPES_MAX };

typedef struct OperatorTerms {
    double mass, damping, stiffness;   // factors of M, C, K in A
    bool lift;   // A may be singular in the interface's own motion (C or K alone): its interface
        // diagonal is raised to factor it, and S lowered again
    bool lower_only;   // of a mesh: S will not be asked for, its Cholesky factor may be
} OperatorTerms;

#endif
