// SPDX-License-Identifier: GPL-2.0-or-later
// A reduced bulk put together of those of its symmetric and its antisymmetric part
// (reduction/mirror). Each part has its own unknowns z on the border, which is the interface and
// the mirrored unknowns u_R: images of those of its unknowns, as of rod nodes, that have none
// there; and its own interior. What u_R moves beside the static motion that follows the interface
// is interior to the whole, in coordinates w with the unit matrix as K:
//
//     x = [ u_b; w; q_0; q_1 ],   u_R = L^-T w - E u_b,   z_p = T_p [u_b; u_R],
//
// E = S_RR^-1 S_Rb and L L' = S_RR of the border's S of K. Called by reduction/reduced_operator and
// reduction/reduced_bulk; made by reduction/symmetry_reduction.
#ifndef AMONTONS_REDUCTION_SYMMETRY_PARTS_H
#define AMONTONS_REDUCTION_SYMMETRY_PARTS_H

#include "reduction/transform.h"

// Mirrored unknowns condensed out of an S on the border.
typedef struct MirroredDofs {
    double *follow;   // [mirrored * m] E = S_RR^-1 S_Rb; owned
    double *lower;   // [mirrored^2] L of S_RR; owned
} MirroredDofs;

// border: [m + count, squared] S. schur [m^2] := S_bb - S_bR E; NULL: not asked for.
// ERROR_COMPUTE: S_RR is not definite.
bool mirrored_dofs_condense(const double *border, int32_t m, int32_t count, MirroredDofs *mirrored,
                            double *schur, Error *err);
void mirrored_dofs_destroy(MirroredDofs *mirrored);

typedef struct SymmetryParts {
    int32_t interface_count, mirrored;   // m; unknowns of w
    int32_t interior[2];   // q of each part
    Transform border[2];   // of [u_b; u_R]; owned, like all below
    Transform mesh[2];   // of the whole mesh's unknowns; empty where the modes are not at hand
    MirroredDofs at_rest;   // of K
} SymmetryParts;

void symmetry_parts_destroy(SymmetryParts *symmetry);

// Motions x into local[p] = [z; q], and back. border: [m + mirrored] work.
void symmetry_parts_split_motion(const SymmetryParts *symmetry, const double *x,
                                 double *const local[2], double *border);
void symmetry_parts_join_motion(const SymmetryParts *symmetry, const double *const local[2],
                                double *x, double *border);
// Forces: what does the same work.
void symmetry_parts_split_force(const SymmetryParts *symmetry, const double *force,
                                double *const local[2], double *border);
void symmetry_parts_join_force(const SymmetryParts *symmetry, const double *const local[2],
                               double *force, double *border);

#endif
