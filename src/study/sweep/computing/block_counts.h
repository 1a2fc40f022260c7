// SPDX-License-Identifier: GPL-2.0-or-later
// How many points of a study step on the same reduced block, so that its cost is shared: what a
// study's `reduction.use: auto` counts. Called by study/sweep/sweep.
#ifndef AMONTONS_STUDY_SWEEP_COMPUTING_BLOCK_COUNTS_H
#define AMONTONS_STUDY_SWEEP_COMPUTING_BLOCK_COUNTS_H

#include "study/sweep/computing/point.h"

// One for each point, in the study's order.
typedef struct BlockCounts {
    Hash *blocks;   // [point_count] what the basis of each point depends on; owned
    int32_t count;   // noted so far
} BlockCounts;

bool block_counts_create(int32_t points, BlockCounts *counts, Error *err);
void block_counts_destroy(BlockCounts *counts);

// The next point's scene; `mesh`: the hash of its file, as point_hash has left it.
bool block_counts_note(const Scene *scene, const PointMesh *mesh, BlockCounts *counts, Error *err);

// Sets `runs` of all points: those with the same block, computed before or not, so that a study
// that is taken up again goes on as it began.
bool block_counts_set(const BlockCounts *counts, SweepPoint *points, Error *err);

#endif
