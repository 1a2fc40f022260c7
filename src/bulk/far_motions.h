// SPDX-License-Identifier: GPL-2.0-or-later
// Motions of a layer of unknowns, all others at rest: orthonormal in K/E but for rounding, grown
// from answers of the mesh, of which only what the others lack is taken. Used by bulk/far_samples
// and bulk/far_field.
#ifndef AMONTONS_BULK_FAR_MOTIONS_H
#define AMONTONS_BULK_FAR_MOTIONS_H

#include "base/dense.h"
#include "bulk/interface_operator.h"

typedef struct FarMotions {
    int32_t size;   // unknowns
    int32_t *dofs;   // [size] which of the mesh, ascending; owned, as what follows
    SparsePattern pattern;   // of their own K and C
    double *stiffness, *damping;   // [entries] K/E, C
    int32_t count, room;   // columns
    double *field;   // [size * room] F, F'(K/E)F = 1
    double *image;   // [size * room] (K/E) F
    int32_t columns_max;   // of fields at once
    double *rows, *next;   // [size * columns_max] work: their rows here, the image of these
    double *work[2];   // [size * SPARSE_WIDE] of two threads
} FarMotions;

// None yet. motions->dofs and size are set, by far_block, columns_max by far_samples; unit: E.
// There is room for `expected`; memory that is never written to is never there.
bool far_motions_begin(const Bulk *bulk, double unit, int32_t expected, FarMotions *motions,
                       Error *err);
void far_motions_destroy(FarMotions *motions);

// Takes up what of `fields` [dofs of the mesh, columns] has an energy above `least` beyond the
// motions that are there; *added of them.
bool far_motions_add(FarMotions *motions, DenseView fields, double least, int32_t *added,
                     Error *err);

// square[term] [count^2]: F'(K/E)F, F'CF, F'MF by BulkTerm; mass: [dofs of the mesh].
bool far_motions_project(const FarMotions *motions, const double *mass,
                         double *const square[BULK_TERMS], Error *err);

#endif
