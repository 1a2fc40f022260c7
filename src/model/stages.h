// SPDX-License-Identifier: GPL-2.0-or-later
// How many stages a run will take, about, from what its rod drives. Called by model/obtain.
#ifndef AMONTONS_MODEL_STAGES_H
#define AMONTONS_MODEL_STAGES_H

#include "model/model.h"

// The block as one mass that a spring and a damper drive: what is below the rod, the layer or pads
// on the floor, and the machine, one behind the other.
typedef struct Drive {
    double load;   // F_N, force
    double yield;   // of the rod for each unit of force, until all yields no more, length / force
    double damping;   // of the same motion, force * time / length
    double mass;   // of the block, force * time^2 / length
    int32_t watched;   // contact nodes on a floor that waves are slow in; 0: it is not
    double weakening;   // -mu' F_N of slip as fast as the rod, force * time / length
} Drive;

Drive stages_drive(const Model *model);

// To the scene's end.
double stages_expect(const Scene *scene, const Drive *drive);

#endif
