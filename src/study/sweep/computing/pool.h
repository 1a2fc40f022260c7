// SPDX-License-Identifier: GPL-2.0-or-later
// Computes pending points in processes of this computer.
#ifndef AMONTONS_STUDY_SWEEP_COMPUTING_POOL_H
#define AMONTONS_STUDY_SWEEP_COMPUTING_POOL_H

#include "study/sweep/computing/point.h"

// jobs: points at a time; 0: as many as there are cores. Every step-th point is looked at.
bool pool_run(Sweep *sweep, int32_t jobs, int32_t step, Error *err);

#endif
