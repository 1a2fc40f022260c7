// SPDX-License-Identifier: GPL-2.0-or-later
// The interface matrix S of one step size, with what the contact keeps of it: S with open nodes
// condensed out, which lives and ends with S, so that no other matrix can be mistaken for it. Open
// nodes O carry no force: their motion follows from the others', which meet
//
//     S' = S - S_.O S_OO^-1 S_O.
//
// Blocks on pads have most of their nodes open while few slip. A node that opens or closes changes
// S' by two sweeps, which cost as much as a few products with S; factoring S_OO in every linear
// system costs far more. Made by stepping/dt_levels for each step size and by stepping/certificate
// for the damping alone; used by contact/contact_newton.
#ifndef AMONTONS_CONTACT_CONTACT_MATRIX_H
#define AMONTONS_CONTACT_CONTACT_MATRIX_H

#include "base/archive.h"

#include <stdint.h>

typedef struct ContactMatrix {
    const double *schur;   // S [count^2], symmetric; not owned, stands as long as this
    int32_t count;   // interface unknowns
    double *own;   // [count] the diagonal of S; owned
    double diagonal;   // its largest entry
    double *closed;   // [count^2] S swept on `out`, both triangles; owned, like all that follows
    uint8_t *out;   // [count] 1: the unknown is swept
    double *work;   // [48 count]
    int32_t swept;   // sweeps since `closed` was copied from S; -1: it is no copy
    int64_t sweeps;   // counted
    int32_t *order;   // [swept] the unknowns swept since then, ~k where others are swept together
        // with k: rounding depends on it
    int64_t factored;   // which of contact/contact_newton's factorisations is of it; 0: none
} ContactMatrix;

// schur: [count^2]. *matrix is overwritten; on failure contact_matrix_destroy frees what was
// made. Memory for `closed` is taken up as it comes into use.
bool contact_matrix_create(const double *schur, int32_t count, ContactMatrix *matrix, Error *err);
void contact_matrix_destroy(ContactMatrix *matrix);

// S' for the nodes that `status` [contact_count] has open; S itself where none is. Stands until the
// same is asked for with other statuses. NULL: S_OO is nearly singular, nothing holds those nodes.
const double *contact_matrix_close(ContactMatrix *matrix, const uint8_t *status,
                                   int32_t contact_count, int32_t dim);

// Writes or reads its part of a saved state. last: the solver's last factorisation, the one that it
// keeps. S is the same already.
void contact_matrix_archive(ContactMatrix *matrix, int64_t last, Archive *archive);

#endif
