// SPDX-License-Identifier: GPL-2.0-or-later
// A sweep whose cases the caller chooses. Called by study/optimise.
#ifndef AMONTONS_STUDY_SWEEP_SWEEP_H
#define AMONTONS_STUDY_SWEEP_SWEEP_H

#include "amontons.h"
#include "base/error.h"

typedef struct SweepCases {
    const char *text;   // a list of maps in YAML; NULL: those of the study
    const bool
        *known;   // points of a sweep before that `retry` and `fresh` leave as they are; NULL:
        // there was none
    bool pictures;   // are drawn at the end
} SweepCases;

// As amontons_sweep, of the study `path` with these cases. Points count through them, each with all
// of `vary`. A ranking is written, and nothing computed again for it.
bool sweep_cases(const char *path, const SweepCases *cases, const SweepOptions *options,
                 SweepSummary *summary, Error *err);

#endif
