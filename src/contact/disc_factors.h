// SPDX-License-Identifier: GPL-2.0-or-later
// The derivative of a contact problem in space by what is free, and its LU in single precision:
// Newton's residual is of double precision, so that it takes hardly a step more (5757 in place of
// 5730 on a cube of 10 x 10 x 10 cells), and a factor half the time. Used by contact/contact_discs.
#ifndef AMONTONS_CONTACT_DISC_FACTORS_H
#define AMONTONS_CONTACT_DISC_FACTORS_H

#include "contact/contact_newton.h"
#include "contact/slip.h"

// The two equations of a slipping node.
typedef struct DiscRow {
    double d[TANGENTS_MAX];   // along z, against friction; e = (-d[1], d[0])
    double mu;
    double theta, rho;   // rho: force/width per velocity
    double along[TANGENTS_MAX];   // mu' r_n v_t/s: how friction along d answers to v_t
} DiscRow;

typedef struct DiscFactors {
    float *lu;   // [rows^2] of the derivative over the largest entry of S; owned, like what follows
    int32_t *pivots;   // [rows]
    float *single;   // [interface->count] work
    double *column;   // [interface->count] work
    int32_t rows;   // 0: there are none
} DiscFactors;

bool disc_factors_create(const Interface *interface, DiscFactors *factors, Error *err);
void disc_factors_destroy(DiscFactors *factors);

// Column b of the derivative, out [free_count], of what `newton` lists as free. row:
// [contact_count] of nodes that slip.
void disc_column(const ContactNewton *newton, const DiscRow *row, int32_t b, double *out);

// false: it is singular.
bool disc_factors_make(DiscFactors *factors, const ContactNewton *newton, const DiscRow *row);
// x [rows] := J^-1 x, for the same matrix.
void disc_factors_solve(const DiscFactors *factors, const ContactNewton *newton, double *x);

// count: interface unknowns.
void disc_factors_archive(DiscFactors *factors, int32_t count, Archive *archive);

#endif
