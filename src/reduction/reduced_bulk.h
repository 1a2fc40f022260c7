// SPDX-License-Identifier: GPL-2.0-or-later
// The bulk as a sum of small dense systems, which share no entry: itself, or its symmetric and its
// antisymmetric part, of each of which there may be two likewise (reduction/mirror). A part has its
// unknowns z on the border first, then the coordinates q of an interior basis,
//
//     u = [ I   0   ] [ z ]      K = [ S_K 0 ]      M = [ M_bb M_bq ]    C full,
//         [ Psi Phi ] [ q ]          [ 0   I ]          [ M_qb D    ],
//
// D diagonal: a product with M or K costs m r, not (m + r)^2. The border is the interface u_b
// and the mirrored unknowns u_R: images of those of its unknowns, as of rod nodes, that are not on
// it. A state is x = [ u_b; u_R; q_0; q_1 ], z_p = T_p' [u_b; u_R]: all T_p side by side turn the
// border, so that forces are split and joined as motions are.
//
// All matrices are normalised: K/E, C/eta, M/(rho L^2) with lengths over L, as those of the shapes
// of materials' branches are (fem/spectrum); so one serves every size and stiffness of a shape.
// Built by reduction/reduction, stored by model/basis_cache, used through
// reduction/interface_operator.
#ifndef AMONTONS_REDUCTION_REDUCED_BULK_H
#define AMONTONS_REDUCTION_REDUCED_BULK_H

#include "fem/spectrum.h"
#include "reduction/transform.h"

// Factors from the normalised matrices to those of a scene.
typedef struct BulkScales {
    double stiffness;   // E, stress
    double damping;   // eta1 + eta2, stress * time
    double mass;   // rho L^2, mass/width
    double load;   // size of the load vector, force/width
} BulkScales;

enum { REDUCTION_LEVELS_MAX = 64 };

// Errors of S, measured on the full mesh: a Galerkin reduction is too stiff, never too soft, and
//
//     error = largest eigenvalue of L^-1 (S_reduced - S) L^-T,   S = L L',
//
// is the largest relative error of the resistance v'S v to any motion v of the interface.
typedef struct ReductionErrors {
    int32_t count;
    double inertia[REDUCTION_LEVELS_MAX];   // [count] ascending; the last stands for infinity
    double error[REDUCTION_LEVELS_MAX];   // [count] the largest of those at several viscosities
} ReductionErrors;

typedef struct ReducedPart {
    int32_t full_dofs;   // of its mesh
    int32_t border_count;   // m
    int32_t interior_count;   // r
    int32_t count;   // m + r
    double *stiffness, *mass;   // [m^2] S_K and M_bb, symmetric, normalised; owned, like all below
    double *coupling;   // [r * m] M_qb; K has none
    double *masses;   // [r] D; of K 1 each
    double *damping;   // [count^2] C, both triangles
    int32_t shape_count;
    double *shape[SPECTRUM_SHAPES_MAX];   // [shape_count][count^2] S_j likewise
    double *load;   // [count] of the unit load
    double *modes;   // [full_dofs * count] u = modes [z; q]; NULL: not at hand
    ReductionErrors errors;
    Transform border;   // T_p, of the whole's border
    Transform mesh;   // of the whole mesh's unknowns; where the modes are at hand
} ReducedPart;

enum { REDUCED_PARTS_MAX = 1 << (DIM_MAX - 1) };   // two for each axis of the floor

typedef struct ReducedBulk {
    int32_t dim;
    int32_t full_dofs;
    double area;   // of the block over L^2; in space its volume over L^3
    int32_t interface_count;
    int32_t mirrored;   // unknowns of u_R
    int32_t count;   // of x
    int32_t part_count;
    ReducedPart part[REDUCED_PARTS_MAX];
    double *load;   // [count] of the unit load; owned
    double
        *rigid;   // [rigid_count(dim)][interface + mirrored] lengths over L, from the trailing end
    // on; all interior stays at 0; owned; NULL: none are asked for
    BulkScales scales;
    Spectrum spectrum;   // of the materials' branches, times in the scene's unit; share * S_j of a
        // part is a stiffness of the scene
} ReducedBulk;

// Rigid motions of a block: unit translations along each axis, then unit rotations about the
// origin, that of x and height first: (-z, x).
int32_t rigid_count(int32_t dim);
double rigid_motion(int32_t dim, int32_t which, const double *place, int32_t axis);

void reduced_part_destroy(ReducedPart *part);
void reduced_bulk_destroy(ReducedBulk *reduced);

// The error of S to expect at `inertia` (normalised, see reduction/reduction): the larger of those
// measured on either side of it.
double reduced_bulk_error(const ReducedBulk *reduced, double inertia);

// full [full_dofs] = modes * state [count] of several states, at far less than the cost of as many
// calls. The modes must be at hand.
bool reduced_bulk_recover(const ReducedBulk *reduced, int32_t count, const double *const *states,
                          double *const *full, Error *err);

// The transpose of that, modes' * full: forces on the mesh, or the coefficients of a linear reading
// of its motion, become those of the state. row [count]. The modes must be at hand.
bool reduced_bulk_project(const ReducedBulk *reduced, const double *full, double *row, Error *err);

// Motions or forces x [count] into those of the parts, local[p] = [z; q], and back.
void reduced_bulk_split(const ReducedBulk *reduced, const double *x, double *const *local);
void reduced_bulk_join(const ReducedBulk *reduced, const double *const *local, double *x);

#endif
