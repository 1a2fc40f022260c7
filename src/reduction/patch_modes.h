// SPDX-License-Identifier: GPL-2.0-or-later
// Modes of a patch of unknowns, all others at rest: orthonormal in K/E but for rounding, grown
// from responses of the mesh, of which only what the others lack is taken. Made by
// reduction/far_patches; used by reduction/far_samples and reduction/far_field.
#ifndef AMONTONS_REDUCTION_PATCH_MODES_H
#define AMONTONS_REDUCTION_PATCH_MODES_H

#include "algebra/dense.h"
#include "reduction/interface_operator.h"

typedef struct PatchModes {
    int32_t size;   // unknowns
    int32_t *dofs;   // [size] which of the mesh, ascending; owned, as what follows
    SparsePattern pattern;   // of their own K
    double *stiffness;   // [entries] K/E
    int32_t count, room;   // columns
    double *field;   // [size * room] F, F'(K/E)F = 1
    double *image;   // [size * room] (K/E) F
} PatchModes;

// Work arrays of one thread, used patch by patch.
typedef struct FarRoom {
    double *rows, *next;   // [size * columns] rows of the fields, their image
    double *parts;   // [(size + columns) * columns]
    double *energies, *values, *eigen;   // [columns^2], [columns], [DENSE_EIGEN_WORK(columns)]
} FarRoom;

// For patches of up to `size` unknowns, `columns` fields at once.
bool far_room_create(int64_t size, int64_t columns, FarRoom *room, Error *err);
void far_room_destroy(FarRoom *room);

void patch_modes_destroy(PatchModes *modes);
// For `columns` more; memory that is never written to is never there.
bool patch_modes_make_room(PatchModes *modes, int32_t columns, Error *err);

// Takes up what of `fields` [dofs of the mesh, columns] has an energy above `least` beyond the
// modes that are there; *added of them, for which there is room. false: LAPACK finds no energies.
bool patch_modes_add(PatchModes *modes, DenseView fields, double least, FarRoom *room,
                     int32_t *added);

#endif
