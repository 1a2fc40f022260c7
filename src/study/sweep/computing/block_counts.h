// SPDX-License-Identifier: GPL-2.0-or-later
// How many points of a study step on the same reduced block, so that its cost is shared: what a
// study's `reduction.use: auto` counts. Called by study/sweep/sweep.
#ifndef AMONTONS_STUDY_SWEEP_COMPUTING_BLOCK_COUNTS_H
#define AMONTONS_STUDY_SWEEP_COMPUTING_BLOCK_COUNTS_H

#include "study/sweep/computing/point.h"

// The point's scene; `mesh`: the hash of its file, as point_hash has left it.
bool block_note(const Scene *scene, const PointMesh *mesh, SweepPoint *point, Error *err);

// Sets `runs` of all points: those with the same block, computed before or not, so that a study
// that is taken up again goes on as it began.
bool blocks_count(SweepPoint *points, int32_t count, Error *err);

#endif
