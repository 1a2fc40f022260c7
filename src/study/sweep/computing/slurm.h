// SPDX-License-Identifier: GPL-2.0-or-later
// Computes pending points as Slurm job arrays and waits for them: an element a share.
#ifndef AMONTONS_STUDY_SWEEP_COMPUTING_SLURM_H
#define AMONTONS_STUDY_SWEEP_COMPUTING_SLURM_H

#include "study/sweep/computing/point.h"

bool slurm_run(Sweep *sweep, Error *err);
// Cancels what an earlier sweep in this folder, itself killed, left to Slurm.
bool slurm_end_leftovers(const Sweep *sweep, Error *err);

#endif
