// SPDX-License-Identifier: GPL-2.0-or-later
// The full mesh's interface operators at points that are known beforehand, each with its response
// to the load, made in two threads in turns: one while the caller works with the one before,
// both while it waits.
// Called by reduction/reduction and reduction/far_samples.
#ifndef AMONTONS_REDUCTION_FACTORS_AHEAD_H
#define AMONTONS_REDUCTION_FACTORS_AHEAD_H

#include "reduction/interface_operator.h"

typedef struct FactorsAhead FactorsAhead;

typedef struct FactoredPoint {
    InterfaceOperator *full;
    double *held;   // [dofs] the response to the load, the interface held
    double *pull;   // [interface_count] what is condensed of it
} FactoredPoint;

typedef struct FactorsAheadDef {
    const BulkOperator *system;   // the full mesh's; the caller may work with it meanwhile
    const double *load;   // [dofs]
    const OperatorTerms *terms;   // [count] in this order, and more (factors_ahead_extend)
    int32_t count;   // two at least
} FactorsAheadDef;

// What `def` points to must outlive it.
bool factors_ahead_create(const FactorsAheadDef *def, FactorsAhead **ahead, Error *err);
// There are `count` terms now. Before the first is taken.
void factors_ahead_extend(FactorsAhead *ahead, int32_t count);
// The next one; the one before is gone.
bool factors_ahead_next(FactorsAhead *ahead, FactoredPoint *point, Error *err);
void factors_ahead_destroy(FactorsAhead *ahead);   // NULL is fine

#endif
