// SPDX-License-Identifier: GPL-2.0-or-later
// `time.scheme: explicit`: stepping/explicit_reference runs the time loop in place of step control.
// Only the loop is explicit: the block is relaxed by the implicit scheme before, for at the
// explicit step that would take longer than many a run; so both schemes start from one state of
// rest.
//
// Recorders see one recording interval, many explicit steps long, as one step, so that a benchmark
// does not measure the recording. RunCounters.accepted counts the explicit steps, and run.json's
// `levels` has one entry, the explicit step size. Called by run/simulation.
#ifndef AMONTONS_RUN_EXPLICIT_LOOP_H
#define AMONTONS_RUN_EXPLICIT_LOOP_H

#include "run/simulation_state.h"

// After relaxation: chooses the step (the stable one, or time.step_max where that is shorter).
// Does nothing under another scheme.
bool explicit_loop_prepare(Simulation *simulation, Error *err);

#endif
