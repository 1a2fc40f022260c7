// SPDX-License-Identifier: GPL-2.0-or-later
// Modes of what is far from the interface, from responses of the whole mesh to boundary motions
// drawn at random (Halko, Martinsson, Tropp, SIAM Review 53, 2011; for substructures:
// Buhr and Smetana, SIAM J. Sci. Comput. 40, 2018). Used by reduction/far_field.
#ifndef AMONTONS_REDUCTION_FAR_SAMPLES_H
#define AMONTONS_REDUCTION_FAR_SAMPLES_H

#include "reduction/far_patches.h"
#include "reduction/training_points.h"

typedef struct FarFieldDef {
    double tolerance;   // of the reduction
    BulkScales scales;
    Materials materials;
} FarFieldDef;

// What the whole mesh says, of which the first line is given. `bulk` must outlive it: its
// last factor is made while the caller goes on.
typedef struct FarSamples {
    FarPatches *patches;   // begun and filled; not owned
    double *stiffness;   // [interface_count^2] S of K/E; owned
    double slowest;   // inertia of the interior's slowest mode (reduction/inertias)
    struct Sampling *sampling;   // what the comparison needs; owned
    double allowed;   // error of S where it is compared
} FarSamples;

bool far_samples_take(const Bulk *bulk, const int32_t *interface_dofs, int32_t interface_count,
                      const FarFieldDef *def, FarSamples *samples, Error *err);
// *error: the largest relative one of S of `system` at a point where nothing was asked, over what
// is allowed. Once.
bool far_samples_compare(FarSamples *samples, BulkOperator *system, double *error, Error *err);
void far_samples_destroy(FarSamples *samples);

#endif
