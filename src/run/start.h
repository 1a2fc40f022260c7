// SPDX-License-Identifier: GPL-2.0-or-later
// From a model that stands to t = 0: step control, relaxation, the rod in place, explicit steps.
// Called by run/simulation, in this order.
#ifndef AMONTONS_RUN_START_H
#define AMONTONS_RUN_START_H

#include "run/simulation_state.h"

bool start_prepare_steps(Simulation *simulation, Error *err);
// Rod and load follow the scene's programs from now on.
void start_programs(Simulation *simulation);
bool start_relax(Simulation *simulation, Error *err);
// After relaxing, which is implicit for both schemes: at the explicit step it would take longer
// than many a run, and so both start from one state of rest. Chooses the step of `time.scheme:
// explicit` (the stable one, or time.step_max where that is shorter); nothing under another scheme.
// Recorders see one recording interval, many explicit steps long, as one step, so that a benchmark
// does not measure the recording. RunCounters.accepted counts the explicit steps, and run.json's
// `rungs` has one entry, the explicit step size.
bool start_explicit_steps(Simulation *simulation, Error *err);

#endif
