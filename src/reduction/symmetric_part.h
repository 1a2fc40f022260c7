// SPDX-License-Identifier: GPL-2.0-or-later
// The symmetric part of a system's motions or forces, that which is its own image across y: on a
// mesh half of what a node and its image have together, in a reduced bulk its symmetric parts
// (reduction/mirror). K, C and M join no symmetric motion to an antisymmetric one, so that both
// have energies of their own. Used by stepping/half_step.
#ifndef AMONTONS_REDUCTION_SYMMETRIC_PART_H
#define AMONTONS_REDUCTION_SYMMETRIC_PART_H

#include "reduction/interface_operator.h"

typedef struct SymmetricPart {
    const BulkOperator *system;   // not owned
    bool exists;   // false: the system is not split by the mirror, all else has no meaning
    int32_t *image;   // full: [dof_count] unknown across the mirror; owned
    bool kept[REDUCED_PARTS_MAX];   // reduced: the part is symmetric
} SymmetricPart;

// image, sign: [interface_count] unknown of the interface across the mirror, of those in the middle
// their own, and how it moves in a symmetric motion, 1 or -1. `system` must outlive the part. No
// error if the system is not split so. ERROR_MEMORY.
bool symmetric_part_find(const BulkOperator *system, const int32_t *image, const double *sign,
                         SymmetricPart *part, Error *err);
void symmetric_part_destroy(SymmetricPart *part);

// out [dof_count] := symmetric part of x [dof_count], distinct.
void symmetric_part_take(const SymmetricPart *part, const double *x, double *out);

// The largest entry of the antisymmetric part of x [dof_count] over that of all of it. NAN on a
// mesh, where it is not asked for.
double symmetric_part_antisymmetric(const SymmetricPart *part, const double *x);
// From here on, or no longer, the antisymmetric parts of a reduced bulk are at rest and nothing
// pushes them, whatever the system is asked: no product with them is made. On a mesh they act.
void symmetric_part_alone(const SymmetricPart *part, bool alone);

#endif
