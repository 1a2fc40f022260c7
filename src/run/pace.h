// SPDX-License-Identifier: GPL-2.0-or-later
// Refuses a run that does not get on: where a state lets no step be accepted but very short ones
// and does not change, the end would be reached after years. Called by run/simulation.
#ifndef AMONTONS_RUN_PACE_H
#define AMONTONS_RUN_PACE_H

#include "base/error.h"

enum { PACE_STEPS = 20000 };   // between looks: an event takes some hundred steps

typedef struct Pace {
    int64_t steps;   // accepted at the last look
    double time;   // reached then
} Pace;

// After each accepted step. `steps` accepted so far, `time` reached, `end` of the run.
// ERROR_COMPUTE: at the pace of the last PACE_STEPS steps it would take more than 1e8 more.
bool pace_check(Pace *pace, int64_t steps, double time, double end, Error *err);

#endif
