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
// Puts the explicit scheme in the place of step control: central differences on the full mesh
// (stepping/explicit_reference). Does nothing for an implicit scheme. Called after relaxing, which
// is implicit for both schemes: at the explicit step it would take longer than many a run, and so
// both start from one state of rest.
//
// The step is the longest stable one (stepping/stable_step), or time.step_max where that is
// shorter, shortened so that a whole number of steps makes a recording interval. Recorders see such
// an interval as one step, so that a benchmark does not measure the recording, and while slip is
// rapid as many states as with implicit steps. Parts that only implicit steps have (step-size
// levels, error control) stand still. RunCounters.accepted counts the explicit steps, and
// run.json's `step_sizes` has one entry, the explicit step size.
bool start_explicit_steps(Simulation *simulation, Error *err);

#endif
