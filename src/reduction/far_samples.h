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

// Samples of the whole mesh; the first field is given.
typedef struct FarSamples {
    FarPatches *patches;   // begun and filled; not owned
    double *stiffness;   // [interface_count^2] S of K/E; owned by who calls
    double slowest;   // inertia of the interior's slowest mode (reduction/training_points)
    OperatorTerms compared;   // where S is compared
    double allowed;   // error of it there
} FarSamples;

// mesh: the operator of the whole.
bool far_samples_take(BulkOperator *mesh, const FarFieldDef *def, FarSamples *samples, Error *err);
// *error: the largest relative one of S of what is left at a point where nothing was asked, over
// what is allowed.
bool far_samples_compare(const FarSamples *samples, BulkOperator *mesh, BulkOperator *left,
                         double *error, Error *err);

#endif
