// SPDX-License-Identifier: GPL-2.0-or-later
// One side of a contact in space that is its own mirror image across y. Where motion and forces are
// their own images, too, one side says all: with E the motions of both sides by those of one,
//
//     v = E w,    u = E'(what pushes),    E'S E w = E'g + E'r,
//
// which is a contact problem of half the size with the statuses of the whole one: a node beside the
// middle line stands for two, its forces are the sum of theirs, and |r_t| <= mu r_n of the sum is
// that of each. For the antisymmetric part, opposite across the mirror, E has the other sign, and S
// is the sum of both: no term joins them, so that a matrix is positive definite where both of its
// halves are. On the middle line nothing moves across in the symmetric part, nor along or up in the
// antisymmetric one. Such an unknown stays with a 1 x 1 block of its own, that nothing pushes.
// Found by stepping/half_step; S is asked for its halves by stepping/dt_levels.
#ifndef AMONTONS_CONTACT_CONTACT_HALF_H
#define AMONTONS_CONTACT_CONTACT_HALF_H

#include "contact/contact_problem.h"

// The part of motions and forces that is looked at: all of them, or the symmetric or antisymmetric
// part, on one side.
typedef enum ContactPart {
    PART_WHOLE,
    PART_SYMMETRIC,
    PART_ANTISYMMETRIC,
    CONTACT_PARTS
} ContactPart;

typedef struct ContactHalf {
    Interface interface;   // how many nodes and unknowns one side has; nothing else; 0: the contact
        // is not its own image
    int32_t both_count;   // interface unknowns of both sides
    int32_t *unknown, *image;   // [interface.count] of the whole: its own, and that across the
        // mirror, the same on the middle line; owned, like all that follows
    double *
        sign;   // [interface.count] of the symmetric part: the image's motion over its own, 1 or -1
    int32_t *node, *node_image;   // [contact_count] of the whole
    int32_t *rod, *rod_image;   // [rod_count] of the whole
} ContactHalf;

// Nothing is found in the plane.
bool contact_half_find(const Interface *interface, ContactHalf *half, Error *err);
void contact_half_destroy(ContactHalf *half);

// out [interface.count^2] = E'S E of the symmetric or antisymmetric part; S: [both_count^2]. false:
// S is not its own image.
bool contact_half_matrix(const ContactHalf *half, const double *schur, bool antisymmetric,
                         double *out);

// The symmetric or antisymmetric part of both sides, on one: of motions, and of forces.
void contact_half_fold(const ContactHalf *half, bool antisymmetric, const double *motion,
                       double *out);
void contact_half_fold_forces(const ContactHalf *half, bool antisymmetric, const double *force,
                              double *out);
// Added to what both sides have.
void contact_half_add(const ContactHalf *half, bool antisymmetric, const double *motion,
                      double *out);
void contact_half_add_forces(const ContactHalf *half, bool antisymmetric, const double *force,
                             double *out);
// Leaves the symmetric part of both sides alone, of motions, and of forces. work: [interface.count]
void contact_half_symmetrise(const ContactHalf *half, double *motion, double *work);
void contact_half_symmetrise_forces(const ContactHalf *half, double *force, double *work);
// Statuses and which rod nodes touch: of one side, and the same of both.
void contact_half_fold_statuses(const ContactHalf *half, const uint8_t *status,
                                const uint8_t *touches, const ContactSolution *out);
void contact_half_unfold_statuses(const ContactHalf *half, const ContactSolution *from,
                                  uint8_t *status, uint8_t *touches);

#endif
