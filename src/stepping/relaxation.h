// SPDX-License-Identifier: GPL-2.0-or-later
// Before the rod moves the block settles under its load until nothing moves any more; then t = 0.
// Called by run/start.
#ifndef AMONTONS_STEPPING_RELAXATION_H
#define AMONTONS_STEPPING_RELAXATION_H

#include "stepping/step_control.h"

typedef struct RelaxationDef {
    double speed_max;   // settled when every speed is below this, velocity
    double duration_max;   // ERROR_COMPUTE beyond it, time
    bool (*may_go_on)(const void *self, Error *err);   // asked after each step; NULL: it may
    const void *self;
} RelaxationDef;

// Steps `control` with the rod as it stands until it has settled; step_control_restart after it
// forbids again steps longer than step_max. steps: how many it took.
bool relax(StepControl *control, const RelaxationDef *def, int64_t *steps, Error *err);

#endif
