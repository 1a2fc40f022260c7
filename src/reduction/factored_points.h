// SPDX-License-Identifier: GPL-2.0-or-later
// The full mesh's interface operators at points that are known beforehand, each with its response
// to the load: as many are factored at once as there are threads, and looked at in their order.
// Called by reduction/reduction and reduction/far_samples.
#ifndef AMONTONS_REDUCTION_FACTORED_POINTS_H
#define AMONTONS_REDUCTION_FACTORED_POINTS_H

#include "reduction/interface_operator.h"

typedef struct FactoredPoint {
    InterfaceOperator *full;
    double *held;   // [dofs] the response to the load, the interface held
    double *pull;   // [interface_count] what is condensed of it
} FactoredPoint;

typedef struct FactoredPointsDef {
    const BulkOperator *system;   // the full mesh's
    const double *load;   // [dofs]
    const OperatorTerms *terms;   // [count]
    int32_t count;
    // Is called for term `k`; the point is gone afterwards.
    bool (*visit)(void *context, int32_t k, const FactoredPoint *point, Error *err);
    void *context;
} FactoredPointsDef;

bool factored_points_visit(const FactoredPointsDef *def, Error *err);

#endif
