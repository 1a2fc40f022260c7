// SPDX-License-Identifier: GPL-2.0-or-later
// The bulk is linear; only the interface is not. So it is reduced once, before time stepping, to
// the interface's own unknowns and a small interior basis (component mode synthesis: Craig and
// Bampton, AIAA J. 6, 1968, with responses at real shifts in place of vibration modes, because C is
// not proportional to K):
//
//     u = [ I   0   ] [ u_b ]     Psi = -K_ii^-1 K_ib, static constraint modes
//         [ Psi Phi ] [ q   ]     Phi: what the responses of the full mesh hold beyond them
//
// A Galerkin projection, so M, C, K stay symmetric and positive, and with Phi orthonormal in K
//
//     K = [ S_K 0 ]     M, C full.
//         [ 0   I ]
//
// All matrices are normalised: K/E, C/eta, M/(rho L^2) with lengths over L. A step of any size of a
// block of any length then asks for the interface operator S of
//
//     A = (1 - viscosity) K + viscosity C + inertia M,     0 <= viscosity <= 1,  inertia >= 0,
//
// up to a factor, and the basis is built to answer on all of that strip: one basis serves every L,
// rho, E and eta of a shape, every load of the same pattern, every step. From the slowest mode of
// the interior to the inertia that takes over within one element, S is measured against the full
// mesh, and the directions in which it is off by more than
//
//     tolerance^2 + 2.5 tolerance * inertia / (that of one element)
//
// get their responses added (bulk/reduction.c): the first term because an energy goes with the
// square of what is left out, the second because where inertia acts within an element the mesh
// itself knows no better. Made and kept by model/obtain; used through bulk/interface_operator;
// stored by model/shape_cache.
#ifndef AMONTONS_BULK_REDUCTION_H
#define AMONTONS_BULK_REDUCTION_H

#include "bulk/assembly.h"

// What the normalised matrices are multiplied with to be those of a scene.
typedef struct BulkScales {
    double stiffness;   // E, stress
    double damping;   // eta1 + eta2, stress * time
    double mass;   // rho L^2, mass/width
    double load;   // size of the load vector, force/width
} BulkScales;

typedef struct ReductionDef {
    double tolerance;   // of responses, relative, in the energy norm
    BulkScales scales;   // of the bulk to reduce
} ReductionDef;

enum { REDUCTION_LEVELS_MAX = 64 };

// How far S was off on the full mesh: a Galerkin reduction is too stiff, never too soft, and
//
//     error = largest eigenvalue of L^-1 (S_reduced - S) L^-T,   S = L L',
//
// is the largest relative error of the resistance v'S v to any motion v of the interface.
typedef struct ReductionErrors {
    int32_t count;
    double inertia[REDUCTION_LEVELS_MAX];   // [count] ascending; the last stands for infinity
    double error[REDUCTION_LEVELS_MAX];   // [count] the larger of those at viscosity 0 and 1
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
} ReducedBulk;

// interface_dofs: [interface_count] unknowns of `bulk` that stay.
bool reduction_build(const Bulk *bulk, const int32_t *interface_dofs, int32_t interface_count,
                     const ReductionDef *def, ReducedBulk *reduced, Error *err);
void reduction_destroy(ReducedBulk *reduced);

// The error of S to expect at `inertia` (normalised, see above): the larger of those measured on
// either side of it.
double reduction_error(const ReducedBulk *reduced, double inertia);

// full [full_dofs] = modes * state [count]. The modes must be at hand.
void reduction_recover(const ReducedBulk *reduced, const double *state, double *full);

#endif
