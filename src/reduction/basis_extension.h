// SPDX-License-Identifier: GPL-2.0-or-later
// What columns bring to a basis, as small matrices. Called by reduction/growing_basis and
// reduction/basis_renew.
#ifndef AMONTONS_REDUCTION_BASIS_EXTENSION_H
#define AMONTONS_REDUCTION_BASIS_EXTENSION_H

#include "reduction/basis_state.h"

// Work of one extension by `added` columns: the next block of responses without their static modes,
// or at a renewal modes that were there.
typedef struct Extension {
    int64_t m, count, added;   // count: columns of Phi before
    double *gram[BULK_TERMS];   // [responses * added] X' (K, C, M) X_next
    double *statics;   // [m * added] rows of one of these
    double *others;   // [(responses - m) * added] likewise
    double *parts;   // [m * added]
    double *beside[BULK_TERMS];   // [m * added] Psi' (C, M) Y, Y the new columns
    double *old[BULK_TERMS];   // [count * added] Phi' (K, C, M) Y
    double *own[BULK_TERMS];   // [added^2] Y' (K, C, M) Y
    double *load;   // [added] f'Y
    double *lower;   // [added^2] of the factor of K
    double *along;   // [count * added] L^-1 Phi'K Y
    double largest;   // energy in K of a response
    double loss;   // how much larger that is than what is left of one
} Extension;

// responses: with those of the next block.
bool extension_create(const GrowingBasis *basis, int64_t responses, int64_t count, int64_t added,
                      Extension *x, Error *err);
void extension_destroy(Extension *x);

// out [count * columns] := rows `first` on of a [rows * columns].
void extension_take_rows(const double *a, int64_t rows, int64_t columns, int64_t first,
                         int64_t count, double *out);

// out [count * added] := Phi'Z from rows of X'Z: `statics`, and `others`, so many.
void extension_of_modes(const GrowingBasis *basis, const Extension *x, int64_t others, double *out);

// Rows of the factor of K that belong to the new columns; their loss. false: they are not
// independent, or nothing but rounding is left of one.
bool extension_factor(const GrowingBasis *basis, Extension *x);

// Leaves, of columns that are not independent, combinations that are; the mix has them already.
bool extension_drop_dependent(GrowingBasis *basis, Extension *x, Error *err);

// The columns behind all others; parts and mix are the caller's.
bool extension_take_up(GrowingBasis *basis, const Extension *x, Error *err);

// a [rows * columns] into the upper left corner of a new one, [new_rows * new_columns], zero
// elsewhere; and columns behind those of a [rows * count].
bool extension_grow(double **a, int64_t rows, int64_t columns, int64_t new_rows,
                    int64_t new_columns, Error *err);
bool extension_append(double **a, int64_t rows, int64_t count, const double *columns, int64_t added,
                      Error *err);

// Rows and columns of the mix for the next `responses`, of which the columns of `rotation` are new
// modes; NULL: all of them.
bool extension_grow_mix(GrowingBasis *basis, int64_t responses, const double *rotation,
                        int64_t kept, Error *err);

// The basis's mix as a matrix; as the unit matrix before.
bool extension_spell_out_mix(GrowingBasis *basis, Error *err);

#endif
