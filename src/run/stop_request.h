// SPDX-License-Identifier: GPL-2.0-or-later
// What ends a run before its scene does: the caller, or a deadline. Asked between phases and steps,
// by run/simulation, run/simulation_loop, run/start and run/accuracy_member.
#ifndef AMONTONS_RUN_STOP_REQUEST_H
#define AMONTONS_RUN_STOP_REQUEST_H

#include "run/simulation_state.h"

// ERROR_INTERRUPT: the caller wants a stop, or the time is up.
bool simulation_may_go_on(const Simulation *simulation, Error *err);

#endif
