// SPDX-License-Identifier: GPL-2.0-or-later
// Motions of a patch of unknowns, all others at rest: orthonormal in K/E but for rounding, grown
// from answers of the mesh, of which only what the others lack is taken. Made by
// reduction/far_patches; used by reduction/far_samples and reduction/far_block.
#ifndef AMONTONS_REDUCTION_FAR_MOTIONS_H
#define AMONTONS_REDUCTION_FAR_MOTIONS_H

#include "base/dense.h"
#include "reduction/interface_operator.h"

typedef struct FarMotions {
    int32_t size;   // unknowns
    int32_t *dofs;   // [size] which of the mesh, ascending; owned, as what follows
    SparsePattern pattern;   // of their own K and C
    double *stiffness, *damping;   // [entries] K/E, C
    int32_t count, room;   // columns
    double *field;   // [size * room] F, F'(K/E)F = 1
    double *image;   // [size * room] (K/E) F
} FarMotions;

// What one thread works in, patch by patch.
typedef struct FarRoom {
    double *rows, *next;   // [size * columns] rows of the fields, their image
    double *parts;   // [(size + columns) * columns]
    double *sparse;   // [size * SPARSE_WIDE]
    double *energies, *values, *eigen;   // [columns^2], [columns], [dense_eigen_work(columns)]
} FarRoom;

// For patches of up to `size` unknowns, `columns` fields at once.
bool far_room_create(int64_t size, int64_t columns, FarRoom *room, Error *err);
void far_room_destroy(FarRoom *room);

void far_motions_destroy(FarMotions *motions);
// For `columns` more; memory that is never written to is never there.
bool far_motions_make_room(FarMotions *motions, int32_t columns, Error *err);

// Takes up what of `fields` [dofs of the mesh, columns] has an energy above `least` beyond the
// motions that are there; *added of them, for which there is room. false: LAPACK finds no energies.
bool far_motions_add(FarMotions *motions, DenseView fields, double least, FarRoom *room,
                     int32_t *added);

// square[term] [count^2]: F'(K/E)F, F'CF, F'MF by BulkTerm; mass: [dofs of the mesh].
bool far_motions_project(const FarMotions *motions, const double *mass,
                         double *const square[BULK_TERMS], Error *err);

#endif
