// SPDX-License-Identifier: GPL-2.0-or-later
// A part of a reduced bulk, normalised: products, and its A condensed on the border. It keeps, for
// each A, the inverse of its interior block and the map
//
//     B = A_qq^-1 A_qb,   S = A_bb - A_bq B,   g = rhs_b - B' rhs_q,   v_q = A_qq^-1 rhs_q - B v_b.
//
// A stage reads B twice (the second time what moves of it), half of A_qq^-1 and, for M v, M_qb.
// Called by reduction/reduced_operator.
#ifndef AMONTONS_REDUCTION_PART_OPERATOR_H
#define AMONTONS_REDUCTION_PART_OPERATOR_H

#include "reduction/operator_terms.h"
#include "reduction/reduced_bulk.h"

// y = K x, C x, M x or S_j x, [count] each.
void part_apply(const ReducedPart *part, BulkTerm term, const double *x, double *y);

typedef struct CondensedPart {
    double *inverse;   // [interior^2] A_qq^-1; owned
    double *map;   // [interior * border] B; owned
    double *half;   // [interior] A_qq^-1 rhs_q; owned
} CondensedPart;

// Fills schur [border^2]. weight: [shape_count] of the shape matrices in A.
bool condensed_part_create(const ReducedPart *part, OperatorTerms terms, const double *weight,
                           CondensedPart *condensed, double *schur, Error *err);
void condensed_part_destroy(CondensedPart *condensed);
void condensed_part_condense(const ReducedPart *part, const CondensedPart *condensed,
                             const double *rhs, double *g);
void condensed_part_expand(const ReducedPart *part, const CondensedPart *condensed,
                           const double *border, double *v);

#endif
