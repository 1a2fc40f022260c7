// SPDX-License-Identifier: GPL-2.0-or-later
// LU of the derivative J of a contact problem, made once and kept up to date. From one Newton step
// to the next few rows change: those of nodes whose status does, or that pass a kink of their
// friction law. A row beyond the weakening stays as it is to the bit. So J is the J0 that was
// factored, with a border (Bisschop and Meeraus, Math. Programming 13, 1977),
//
//     [ J0  U ] [ x ]   [ b ]      U: a column D e for each row of J0 that no longer holds (D: the
//     [ V   T ] [ z ] = [ c ]      scale of S), the column of J for each unknown that came in
//
// V and T: the rows as they are now, or D e where an unknown is held again; b is 0 where a row no
// longer holds, c has its right-hand side. With Z = J0^-1 U and P = T - V Z,
//
//     P z = c - V J0^-1 b,     x = J0^-1 b - Z z,
//
// at a few solutions with J0 for each new column and a LU of P. What is in the border stays there
// until J0 is made anew: its column of Z does not depend on the row. Used by
// contact/contact_newton.
#ifndef AMONTONS_CONTACT_CONTACT_FACTORS_H
#define AMONTONS_CONTACT_CONTACT_FACTORS_H

#include "contact/contact_equations.h"

typedef struct ContactFactors {
    int32_t count, room;   // interface unknowns; the border's at most
    double *lu;   // [rows^2] of J0; owned, like all that follows
    int32_t *pivots, *unknown;   // [rows]
    int32_t *normal;   // [rows] of J0's rows, as ContactRow has them, like the next
    double *mu;
    double *beside;   // [rows] and what contact_diagonal had
    int32_t rows;   // of J0; 0: none is kept
    uint8_t *status;   // [contact_count + rod_count] that J is for (contact_copy_statuses)
    int32_t border_count;
    int32_t *border;   // [border_count] unknowns
    double *z;   // [rows * border_count] Z
    double *v;   // [rows * border_count] V'
    double *p;   // [border_count^2] LU of P
    int32_t *p_pivots;   // [border_count]
    int32_t *place, *rank;   // [count] where an unknown stands in J0 and in the border; -1: not
    int32_t *now;   // [count] work: where it stands among what is free; -1: held
    double *diagonal;   // [count] work
    double *inner, *outer;   // [count] work: J0^-1 b; c and z
} ContactFactors;

bool contact_factors_create(const Interface *interface, ContactFactors *factors, Error *err);
void contact_factors_destroy(ContactFactors *factors);

// LU of the derivative as contact_jacobian has it. false: it is singular, and none is kept.
bool contact_factors_make(ContactFactors *factors, const ContactEquations *equations,
                          const double *matrix);

// The same by a border of what is kept, which must be of the same S. false: more has changed than a
// border is good for, a node opened or closed, which changes all of S', or P is singular; what is
// kept is of no more use.
bool contact_factors_update(ContactFactors *factors, const ContactEquations *equations,
                            const double *matrix);

// x [free_count] := J^-1 x for the free unknowns that J was made for. false, and nothing is done:
// J0 is so much nearer to singular than J that digits would be lost.
bool contact_factors_solve(ContactFactors *factors, const ContactEquations *equations, double *x);

void contact_factors_archive(ContactFactors *factors, Archive *archive);

#endif
