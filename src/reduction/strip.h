// SPDX-License-Identifier: GPL-2.0-or-later
// Where in the strip of reduction/reduction a basis is built and its error is measured. Called by
// reduction/reduction.
#ifndef AMONTONS_REDUCTION_STRIP_H
#define AMONTONS_REDUCTION_STRIP_H

#include "reduction/interface_operator.h"
#include "fem/material.h"

// A = (1 - viscosity) K + viscosity C + inertia M, normalised.
typedef struct StripPoint {
    double viscosity, inertia;
} StripPoint;

enum {
    STRIP_VISCOSITIES_MAX = 12,
    STRIP_VISITS_MAX = (REDUCTION_LEVELS_MAX + 1) * STRIP_VISCOSITIES_MAX
};

typedef struct StripVisit {
    StripPoint point;
    int32_t level;   // which of ReductionErrors it tells of
} StripVisit;

typedef struct Strip {
    double element_inertia;   // where mass takes over within an element
    int32_t count;
    StripVisit visits[STRIP_VISITS_MAX];   // [count] in this order
} Strip;

// slowest: the inertia at which the slowest mode of the interior is in balance; element_inertia:
// the largest K/M of one unknown. Fills the levels of `errors`, too.
void strip_list(const Materials *materials, const BulkScales *scales, double slowest,
                double element_inertia, ReductionErrors *errors, Strip *strip);

// What the ends and steps in viscosity are: viscosity [STRIP_VISCOSITIES_MAX] ascending; their
// number.
int32_t strip_viscosities(const Materials *materials, const BulkScales *scales, double *viscosity);

// The relative error of S that is allowed at a point; at a tolerance of 0 that of rounding.
double strip_allowed(const Strip *strip, StripPoint point, double tolerance);

// The point as factors of the scene's own M, C and K.
OperatorTerms strip_terms(StripPoint point, const BulkScales *scales);

#endif
