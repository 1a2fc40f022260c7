// SPDX-License-Identifier: GPL-2.0-or-later
// Points whose rank the errors leave open are computed again with half the error bar, until the
// order is decided or the study's limit (`rank.refine`) is reached. Called by sweep.
#ifndef AMONTONS_STUDY_SWEEP_REFINE_H
#define AMONTONS_STUDY_SWEEP_REFINE_H

#include "study/sweep/computing/point.h"

// A round begins: chosen points get a smaller accuracy.mu, and wait to be computed where no earlier
// sweep did. *before: the points as they were, [point_count], the caller's to free (memory_free);
// *count: chosen, 0 where no more can be decided.
bool refine_begin(Sweep *sweep, SweepPoint **before, int32_t *count, Error *err);
// A round ends, whether it was computed whole or not: a point that came to no result with a smaller
// error keeps the one it had, and is not chosen again.
bool refine_end(Sweep *sweep, const SweepPoint *before, Error *err);

#endif
