// SPDX-License-Identifier: GPL-2.0-or-later
// Parts of a simulation's state, in one list, and the check whether a saved state belongs to it.
// The functions that save and restore are public: amontons_simulation.h.
#ifndef AMONTONS_RUN_SAVED_STATE_H
#define AMONTONS_RUN_SAVED_STATE_H

#include "run/simulation_state.h"

typedef struct SavedHead {
    double time;   // the state's
    HistoryEnd history;   // the one written so far
} SavedHead;

// The simulation may be restored from `state`: its checksum holds, and it was saved by a build of
// these sources from this scene, mesh and basis. ERROR_INPUT, nothing is changed: which of these is
// not so.
bool saved_state_fits(Simulation *simulation, const SavedState *state, SavedHead *head, Error *err);

#endif
