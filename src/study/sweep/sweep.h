// SPDX-License-Identifier: GPL-2.0-or-later
// A sweep whose cases the caller chooses. Called by study/optimise.
#ifndef AMONTONS_STUDY_SWEEP_SWEEP_H
#define AMONTONS_STUDY_SWEEP_SWEEP_H

#include "amontons.h"
#include "base/error.h"

// As amontons_sweep, of the study `path` with the cases in `cases`, a list of maps in YAML. Points
// count through the cases, each with all of `vary`. A ranking is written, and nothing computed
// again for it. pictures: whether they are drawn.
bool sweep_cases(const char *path, const char *cases, bool pictures, const SweepOptions *options,
                 SweepSummary *summary, Error *err);

#endif
