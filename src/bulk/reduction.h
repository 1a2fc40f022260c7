// SPDX-License-Identifier: GPL-2.0-or-later
// The bulk is linear; only the interface is not. So it is reduced once, before time stepping, to
// the interface's own unknowns and a small interior basis (component mode synthesis: Craig and
// Bampton, AIAA J. 6, 1968, with responses at real shifts in place of vibration modes, because C is
// not proportional to K):
//
//     u = [ I   0   ] [ u_b ]     Psi = -K_ii^-1 K_ib, static constraint modes
//         [ Psi Phi ] [ q   ]     Phi: interior responses to unit motions of the interface and to
//                                 the load, at real shifts s, compressed in the energy norm
//
// A Galerkin projection, so M, C, K stay symmetric and positive, and with Phi orthonormal in K
//
//     K = [ S_K 0 ]     M, C full.
//         [ 0   I ]
//
// All matrices are normalised: K/E, C/eta, M/(rho L^2) with lengths over L; the factors are kept
// beside them, so that one basis serves every L, rho, E and eta of a shape. Made and kept by
// run/model; used through bulk/interface_operator; stored by bulk/basis_cache.
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
    double
        tolerance;   // singular values of the responses below this times the largest are left out
    BulkScales scales;
} ReductionDef;

typedef struct ReducedBulk {
    int32_t full_dofs;
    int32_t interface_count;   // m
    int32_t interior_count;   // r
    int32_t count;   // m + r
    double *mass, *damping;   // [count^2] symmetric, both triangles, normalised; owned
    double *stiffness;   // [m^2] S_K; the interior block is the unit matrix; owned
    double *load;   // [count] of the unit load; owned
    double *modes;   // [full_dofs * count] u = modes [u_b; q]; owned; NULL: not at hand
    double error;                // of S(s), measured against the full mesh (bulk/reduction_check)
    double dropped;   // the largest singular value left out, over the largest
    int64_t factorisations;   // spent on it
    BulkScales scales;
} ReducedBulk;

// interface_dofs: [interface_count] unknowns of `bulk` that stay.
bool reduction_build(const Bulk *bulk, const int32_t *interface_dofs, int32_t interface_count,
                     const ReductionDef *def, ReducedBulk *reduced, Error *err);
enum { REDUCTION_SHIFTS_MAX = 24 };
// The shifts a basis for these scales is built at, in units of E/eta, ascending; how many.
int32_t reduction_shifts(const BulkScales *scales, double shifts[REDUCTION_SHIFTS_MAX]);

void reduction_destroy(ReducedBulk *reduced);

// full [full_dofs] = modes * state [count]. The modes must be at hand.
void reduction_recover(const ReducedBulk *reduced, const double *state, double *full);

#endif
