// SPDX-License-Identifier: GPL-2.0-or-later
// The bulk as a small dense system: the unknowns u_b of the interface first, then the coordinates
// q of an interior basis,
//
//     u = [ I   0   ] [ u_b ]      K = [ S_K 0 ]      M = [ M_bb M_bq ]    C full,
//         [ Psi Phi ] [ q   ]          [ 0   I ]          [ M_qb T    ],
//
// T tridiagonal: a product with M or K costs m r, not (m + r)^2. A block that is its own mirror
// image is kept as two of half the size, which share no entry (reduction/symmetry_parts).
//
// All matrices are normalised: K/E, C/eta, M/(rho L^2) with lengths over L; so one serves every
// size and stiffness of a shape. Built by reduction/reduction, stored by model/basis_cache, used
// through reduction/interface_operator.
#ifndef AMONTONS_REDUCTION_REDUCED_BULK_H
#define AMONTONS_REDUCTION_REDUCED_BULK_H

#include "reduction/symmetry_parts.h"

// Factors from the normalised matrices to those of a scene.
typedef struct BulkScales {
    double stiffness;   // E, stress
    double damping;   // eta1 + eta2, stress * time
    double mass;   // rho L^2, mass/width
    double load;   // size of the load vector, force/width
} BulkScales;

enum { REDUCTION_LEVELS_MAX = 64 };

// How far S was off on the full mesh: a Galerkin reduction is too stiff, never too soft, and
//
//     error = largest eigenvalue of L^-1 (S_reduced - S) L^-T,   S = L L',
//
// is the largest relative error of the resistance v'S v to any motion v of the interface.
typedef struct ReductionErrors {
    int32_t count;
    double inertia[REDUCTION_LEVELS_MAX];   // [count] ascending; the last stands for infinity
    double error[REDUCTION_LEVELS_MAX];   // [count] the largest of those at several viscosities
} ReductionErrors;

typedef struct ReducedBulk {
    int32_t full_dofs;
    int32_t interface_count;   // m
    int32_t interior_count;   // r
    int32_t count;   // m + r
    double *mass, *damping;   // [count^2] symmetric, both triangles, normalised; owned
    double *stiffness;   // [m^2] S_K; the interior block is the unit matrix; owned
    double *viscous;   // [m^2] S of C alone; owned; NULL: not at hand
    double *load;   // [count] of the unit load; owned
    double *modes;   // [full_dofs * count] u = modes [u_b; q]; owned; NULL: not at hand
    double *storage;   // the array that those above lie in (a file's); owned; NULL: none
    ReductionErrors errors;
    BulkScales scales;
    // How it is put together of two parts: matrices above but `load` are NULL, errors are theirs,
    // interior unknowns begin with the mirrored ones; owned; NULL: it is in one piece.
    SymmetryParts *symmetry;
    struct ReducedBulk *part;   // [2] those two; owned
} ReducedBulk;

void reduced_bulk_destroy(ReducedBulk *reduced);
// Of normalised matrices and of those of its parts.
void reduced_bulk_set_scales(ReducedBulk *reduced, BulkScales scales);
bool reduced_bulk_has_modes(const ReducedBulk *reduced);

// The error of S to expect at `inertia` (normalised, see reduction/reduction): the larger of those
// measured on either side of it.
double reduced_bulk_error(const ReducedBulk *reduced, double inertia);

// full [full_dofs] = modes * state [count] of several states, at far less than the cost of as many
// calls. The modes must be at hand.
bool reduced_bulk_recover(const ReducedBulk *reduced, int32_t count, const double *const *states,
                          double *const *full, Error *err);

#endif
