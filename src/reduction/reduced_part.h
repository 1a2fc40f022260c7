// SPDX-License-Identifier: GPL-2.0-or-later
// A reduced bulk in one piece, the whole or one of two symmetry parts: products, and its A
// condensed on the interface. It keeps, for each A, the inverse of its interior block and the map
//
//     B = A_qq^-1 A_qb,   S = A_bb - A_bq B,   g = rhs_b - B' rhs_q,   v_q = A_qq^-1 rhs_q - B v_b.
//
// A stage reads B twice (the second time what moves of it), half of A_qq^-1 and, for M v, M_qb.
// Called by reduction/reduced_operator.
#ifndef AMONTONS_REDUCTION_REDUCED_PART_H
#define AMONTONS_REDUCTION_REDUCED_PART_H

#include "reduction/operator_terms.h"
#include "reduction/reduced_bulk.h"

typedef struct ReducedPart {
    const ReducedBulk *reduced;   // one without parts; not owned
    double *interior_mass;   // [2, interior] diagonal of M_qq, what is beside it; owned; NULL: M_qq
        // has more than that
} ReducedPart;

bool reduced_part_create(const ReducedBulk *reduced, ReducedPart *part, Error *err);
void reduced_part_destroy(ReducedPart *part);
// y = K x, C x or M x in the scene's units, [count] each.
void reduced_part_apply(const ReducedPart *part, BulkTerm term, const double *x, double *y);

typedef struct CondensedPart {
    double *inverse;   // [interior^2] A_qq^-1; owned
    double *map;   // [interior * interface] B; owned
    double *half;   // [interior] A_qq^-1 rhs_q; owned
} CondensedPart;

// Fills schur [interface^2]. *taken: it was at hand, and nothing but S can be asked for.
bool condensed_part_create(const ReducedBulk *reduced, OperatorTerms terms, CondensedPart *part,
                           double *schur, bool *taken, Error *err);
void condensed_part_destroy(CondensedPart *part);
void condensed_part_condense(const ReducedBulk *reduced, const CondensedPart *part,
                             const double *rhs, double *g);
void condensed_part_expand(const ReducedBulk *reduced, const CondensedPart *part,
                           const double *interface, double *v);

#endif
