// SPDX-License-Identifier: GPL-2.0-or-later
// From a model that stands to t = 0: step control, relaxation, the rod in place. Called by
// run/simulation, in this order.
#ifndef AMONTONS_RUN_START_H
#define AMONTONS_RUN_START_H

#include "run/simulation_state.h"

bool start_prepare_steps(Simulation *simulation, Error *err);
// Rod and load follow the scene's programs from now on.
void start_programs(Simulation *simulation);
bool start_relax(Simulation *simulation, Error *err);

#endif
