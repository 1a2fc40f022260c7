// SPDX-License-Identifier: GPL-2.0-or-later
// LU of the derivative of a contact problem, kept from one Newton step to the next. Used by
// contact/contact_newton.
#ifndef AMONTONS_CONTACT_CONTACT_FACTORS_H
#define AMONTONS_CONTACT_CONTACT_FACTORS_H

#include "contact/contact_equations.h"

typedef struct ContactFactors {
    int32_t rows;   // 0: none is kept
    double *lu;   // [rows^2]; owned, like all that follows
    int32_t *pivots;   // [rows]
    uint8_t *status;   // [contact_count + rod_count] that it is for (contact_copy_statuses)
} ContactFactors;

bool contact_factors_create(const Interface *interface, ContactFactors *factors, Error *err);
void contact_factors_destroy(ContactFactors *factors);

// LU of the derivative as contact_jacobian has it. false: it is singular, and none is kept.
bool contact_factors_make(ContactFactors *factors, const ContactEquations *equations,
                          const double *matrix);

// x [rows] := J^-1 x.
void contact_factors_solve(const ContactFactors *factors, double *x);

void contact_factors_archive(ContactFactors *factors, int32_t count, Archive *archive);

#endif
