// SPDX-License-Identifier: GPL-2.0-or-later
// output.window by `around` or `last`: a run has passed such a window when it learns where it lies.
// It keeps the states it had at its start and at the ends of the last slidings, is taken back to
// one of them, and goes again: steps repeat themselves to the last bit, and are written this time.
// A state is as large as checkpoint.bin, which holds all of them, and costs as little as writing it
// to memory; steps kept for later would take far more, or be written and removed again. Called by
// run/simulation.
#ifndef AMONTONS_RUN_REWIND_H
#define AMONTONS_RUN_REWIND_H

#include "run/simulation_state.h"

bool rewind_start(Simulation *simulation, Error *err);   // at t = 0
// After a step; *finished becomes false where the run goes again.
bool rewind_follow(Simulation *simulation, bool *finished, Error *err);

#endif
