// SPDX-License-Identifier: GPL-2.0-or-later
// LU of the derivative J of a contact problem, made once and kept up to date. From one Newton step
// to the next few rows change: those of nodes whose status does, or that pass a kink of their
// friction law. A row beyond the weakening stays as it is to the bit. Taken for all unknowns, a row
// of the unit matrix for each that is held, J is the J0 that was factored with rows V in place of
// some, R. So (Woodbury's formula: Hager, SIAM Review 31, 1989)
//
//     J^-1 b = y + Z t,    J0 y = b, 0 in R,    (V Z) t = b_R - V y,    Z = J0^-1 [e_k for k in R]
//
// at one solution with J0 for each row that comes into R, and a LU of V Z. A row in R may change
// again: its column of Z stays as it is. Used by contact/contact_newton.
#ifndef AMONTONS_CONTACT_CONTACT_FACTORS_H
#define AMONTONS_CONTACT_CONTACT_FACTORS_H

#include "contact/contact_equations.h"

// Row k of J: S_k + mu S_normal + beside e_k.
typedef struct FactoredRow {
    int32_t normal;   // as ContactRow has it; -1: the unknown is held
    double mu;
    double beside;   // as contact_diagonal has it
} FactoredRow;

typedef struct ContactFactors {
    int32_t count;   // interface unknowns
    int32_t rows;   // that are free in J0; 0: none is kept
    double *lu;   // [rows^2] of those; owned, like all that follows
    int32_t *pivots;   // [rows]
    int32_t *free;   // [rows] unknowns
    FactoredRow *row;   // [count] of J0
    uint8_t *status;   // [contact_count + rod_count] that J is for (contact_copy_statuses)
    int32_t replaced_count;
    int32_t *replaced;   // [replaced_count] R
    double *z, *v;   // [count * replaced_count] Z and V'
    double *p;   // [replaced_count^2] LU of V Z
    int32_t *p_pivots;   // [replaced_count]
    FactoredRow *now;   // [count] work: rows of J
    double *x, *y, *t;   // [count] work
} ContactFactors;

bool contact_factors_create(const Interface *interface, ContactFactors *factors, Error *err);
void contact_factors_destroy(ContactFactors *factors);

// LU of the derivative as contact_jacobian has it. false: it is singular, and none is kept.
bool contact_factors_make(ContactFactors *factors, const ContactEquations *equations,
                          const double *matrix);

// The same by other rows of what is kept, which must be of the same S. false: more has changed than
// this is good for, a node opened or closed, which changes all of S', or V Z is singular; what is
// kept is of no more use.
bool contact_factors_update(ContactFactors *factors, const ContactEquations *equations,
                            const double *matrix);

// x [free_count] := J^-1 x for the free unknowns that J was made for. false, and nothing is done:
// J0 is so much nearer to singular than J that digits would be lost.
bool contact_factors_solve(ContactFactors *factors, const ContactEquations *equations, double *x);

void contact_factors_archive(ContactFactors *factors, Archive *archive);

#endif
