// SPDX-License-Identifier: GPL-2.0-or-later
// Computes pending points in processes of this computer, options->jobs at a time.
#ifndef AMONTONS_STUDY_SWEEP_POOL_H
#define AMONTONS_STUDY_SWEEP_POOL_H

#include "study/sweep/point.h"

bool pool_run(Sweep *sweep, Error *err);

#endif
