// SPDX-License-Identifier: GPL-2.0-or-later
// The unknowns far from the interface, divided into patches: layers by their distance from it, each
// twice as deep as the one before, and each cut into parts that are nearest to the same part of the
// interface, twice as wide, too. Called by reduction/far_field
// and reduction/far_samples, its counts by model/memory.
#ifndef AMONTONS_REDUCTION_FAR_PATCHES_H
#define AMONTONS_REDUCTION_FAR_PATCHES_H

#include "reduction/patch_modes.h"

// Unknowns of an interface below which factors take more of the time than the products that a far
// field saves (20 x 160 cells, 59 of them: a third slower with it; 60 x 120: an eighth faster).
enum { FAR_INTERFACE = 100 };

enum { NO_PATCH = -1 };   // near

typedef struct FarPatches {
    int32_t distance;   // elements between the interface and the first layer
    int32_t count;   // 0: too little is far
    int32_t *of, *place;   // [dofs] which patch, NO_PATCH; where in it; owned
    PatchModes *modes;   // [count] none yet, `dofs` and `size` set; owned, with all in them
} FarPatches;

// interface_dofs: [m], neighbours side by side.
bool far_patches_create(const SparsePattern *pattern, const int32_t *interface_dofs, int32_t m,
                        FarPatches *patches, Error *err);
// Each patch's own K/E, and room for `expected` modes. unit: E.
bool far_patches_begin(const Bulk *bulk, double unit, int32_t expected, FarPatches *patches,
                       Error *err);
void far_patches_destroy(FarPatches *patches);

// How many of a mesh's unknowns are left where this is done, about: near ones and modes.
double far_patches_left(double unknowns, double interface_count);

#endif
