// SPDX-License-Identifier: GPL-2.0-or-later
// RESULT/checkpoint.bin: a saved state (run/saved_state) that a run goes on from. Written now and
// then, where a run is stopped, and at its end; first all steps of the history are put on the disk,
// so that it goes at least as far. Called by run/simulation.
#ifndef AMONTONS_RUN_CHECKPOINT_H
#define AMONTONS_RUN_CHECKPOINT_H

#include "run/simulation_state.h"

// Is called after each step. A checkpoint that cannot be written is a warning: the run goes on.
void checkpoint_when_due(Simulation *simulation);
bool checkpoint_now(Simulation *simulation, Error *err);
bool checkpoint_is_kept(const Simulation *simulation);   // this run writes any
// A finished result that has a history may be gone on with; others need none.
bool checkpoint_at_end(Simulation *simulation, Error *err);

// Reads the checkpoint of `folder`. ERROR_INPUT: there is none.
bool checkpoint_read(const char *folder, SavedState *state, Error *err);
// Checks that the history of `folder` is that of the checkpoint. ERROR_INPUT: it is another one.
bool checkpoint_check_history(const char *folder, const HistoryEnd *end, Error *err);

#endif
