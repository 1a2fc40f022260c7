// SPDX-License-Identifier: GPL-2.0-or-later
// What the caller is shown of an accepted step. Called by run/simulation and study/line/steps.
#ifndef AMONTONS_RUN_STEP_VIEW_H
#define AMONTONS_RUN_STEP_VIEW_H

#include "amontons.h"
#include "record/events.h"

// t_end: when the scene ends, time.
StepView step_view(const Observation *seen, const Events *events, double t_end);

#endif
