// SPDX-License-Identifier: GPL-2.0-or-later
// Judges a contact state by its conditions alone: knows neither solver nor statuses. Used by run/
// on every accepted step and by the tests.
#ifndef AMONTONS_CONTACT_CONTACT_CHECK_H
#define AMONTONS_CONTACT_CONTACT_CHECK_H

#include "contact/contact_problem.h"

// The largest violation of each condition. Forces are relative to `force_scale`, velocities to
// `velocity_scale`.
typedef struct ContactResidual {
    double penetration;   // bound - v_n (or rod), velocity
    double pull;   // -r_n (or rod), force
    double gap_force;   // min(v_n - bound, r_n) in scaled quantities: pressed though apart
    double cone;   // |r_t| - mu r_n, force
    double direction;   // |r_t + mu r_n v_t/|v_t|| where |v_t| is above rounding, force
} ContactResidual;

ContactResidual contact_residual(const ContactProblem *problem, const double *velocity,
                                 const double *reaction, double force_scale, double velocity_scale);
double contact_residual_max(const ContactResidual *residual);

#endif
