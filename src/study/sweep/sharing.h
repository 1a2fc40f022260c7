// SPDX-License-Identifier: GPL-2.0-or-later
// How many points of a study step on the same reduced block, so that its cost is shared: what a
// study's `reduction.use: auto` counts. Called by study/sweep/sweep.
#ifndef AMONTONS_STUDY_SWEEP_SHARING_H
#define AMONTONS_STUDY_SWEEP_SHARING_H

#include "study/sweep/point.h"

// One for each point, in the study's order.
typedef struct Sharing {
    Hash *blocks;   // [point_count] what the basis of each point depends on; owned
    int32_t count;   // noted so far
} Sharing;

bool sharing_create(int32_t points, Sharing *sharing, Error *err);
void sharing_destroy(Sharing *sharing);

// The next point's scene; `mesh`: the hash of its file, as point_hash has left it.
bool sharing_note(const Scene *scene, const PointMesh *mesh, Sharing *sharing, Error *err);

// Sets `runs` of all points: those with the same block, computed before or not, so that a study
// that is taken up again goes on as it began.
bool sharing_count(const Sharing *sharing, SweepPoint *points, Error *err);

#endif
