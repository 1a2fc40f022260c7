// SPDX-License-Identifier: GPL-2.0-or-later
// The points of the parameter domain of reduction/reduction at which a basis is built and its error
// is measured, and the two ends of its inertia. Called by reduction/reduction and
// reduction/far_samples.
#ifndef AMONTONS_REDUCTION_TRAINING_POINTS_H
#define AMONTONS_REDUCTION_TRAINING_POINTS_H

#include "reduction/interface_operator.h"
#include "fem/material.h"

// A = (1 - viscosity) K + viscosity C + inertia M, normalised.
typedef struct ParameterPoint {
    double viscosity, inertia;
} ParameterPoint;

enum {
    TRAINING_VISCOSITIES_MAX = 12,
    TRAINING_POINTS_MAX = (REDUCTION_LEVELS_MAX + 1) * TRAINING_VISCOSITIES_MAX
};

typedef struct TrainingPoint {
    ParameterPoint point;
    int32_t level;   // which of ReductionErrors it tells of
} TrainingPoint;

typedef struct TrainingPoints {
    double element_inertia;   // where mass takes over within an element
    int32_t count;
    TrainingPoint points[TRAINING_POINTS_MAX];   // [count] in this order
} TrainingPoints;

// slowest: the inertia at which the slowest mode of the interior is in balance; element_inertia:
// the largest K/M of one unknown. spectrum: of the materials' branches, in the units of `scales`.
// Fills the levels of `errors`, too.
void training_points_list(const Materials *materials, const BulkScales *scales,
                          const Spectrum *spectrum, double slowest, double element_inertia,
                          ReductionErrors *errors, TrainingPoints *training);

// Finds the ends and steps in viscosity: viscosity [TRAINING_VISCOSITIES_MAX] ascending; returns
// their number.
int32_t training_viscosities(const Materials *materials, const BulkScales *scales,
                             const Spectrum *spectrum, double *viscosity);

// The relative error of S that is allowed at a point; at a tolerance of 0 that of rounding.
double parameter_error_allowed(const TrainingPoints *training, ParameterPoint point,
                               double tolerance);

// The factors of K, C, M (normalised) and the shape matrices at a point, by BulkTerm.
void parameter_factors(ParameterPoint point, const BulkScales *scales, const Spectrum *spectrum,
                       double *factor);

// The point as factors of the scene's own M, C and K.
OperatorTerms parameter_terms(ParameterPoint point, const BulkScales *scales);

// The inertia at which the slowest mode of the interior is in balance, K x = slowest M x. statics:
// `full` at K/E alone.
bool inertia_slowest(const BulkOperator *full, const BulkScales *scales, InterfaceOperator *statics,
                     double *slowest, Error *err);

// Inertia from which on it rules within one element: the largest K_jj / M_jj of the interface.
double inertia_element(const Bulk *bulk, const BulkScales *scales, const int32_t *interface_dofs,
                       int32_t interface_count);

#endif
