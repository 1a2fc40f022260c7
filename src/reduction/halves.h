// SPDX-License-Identifier: GPL-2.0-or-later
// A reduced bulk put together of those of two halves (reduction/mirror). Each half has its own
// unknowns z on the border, which is the interface and the images of those of its unknowns, as of
// rod nodes, that have none there, and its own interior. What the images u_R move beside the static
// motion that follows the interface is interior to the whole, in coordinates w with the unit matrix
// as K:
//
//     x = [ u_b; w; q_0; q_1 ],   u_R = L^-T w - E u_b,   z_h = T_h [u_b; u_R],
//
// E = S_RR^-1 S_Rb and L L' = S_RR of the border's S of K. Called by reduction/reduced_operator and
// reduction/reduced_bulk; made by reduction/mirrored_reduction.
#ifndef AMONTONS_REDUCTION_HALVES_H
#define AMONTONS_REDUCTION_HALVES_H

#include "reduction/fold.h"

// Images condensed out of an S on the border.
typedef struct FollowingImages {
    double *follow;   // [images * m] E = S_RR^-1 S_Rb; owned
    double *lower;   // [images^2] L of S_RR; owned
} FollowingImages;

// border: [m + count, squared] S. schur [m^2] := S_bb - S_bR E; NULL: not asked for.
// ERROR_COMPUTE: S_RR is not definite.
bool images_condense(const double *border, int32_t m, int32_t count, FollowingImages *images,
                     double *schur, Error *err);
void images_destroy(FollowingImages *images);

typedef struct Halves {
    int32_t interface_count, images;   // m; unknowns of w
    int32_t interior[2];   // q of each half
    Fold border[2];   // of [u_b; u_R]; owned, like all below
    Fold mesh[2];   // of the whole mesh's unknowns; empty where the modes are not at hand
    FollowingImages at_rest;   // of K
} Halves;

void halves_destroy(Halves *halves);

// Motions x into local[h] = [z; q], and back. border: [m + images] work.
void halves_split_motion(const Halves *halves, const double *x, double *const local[2],
                         double *border);
void halves_join_motion(const Halves *halves, const double *const local[2], double *x,
                        double *border);
// Forces: what does the same work.
void halves_split_force(const Halves *halves, const double *force, double *const local[2],
                        double *border);
void halves_join_force(const Halves *halves, const double *const local[2], double *force,
                       double *border);

#endif
