// SPDX-License-Identifier: GPL-2.0-or-later
// Output that a scene asks for, opened as recorders or drawn at the end. Called by run/simulation;
// output that is not asked for is never called.
#ifndef AMONTONS_RUN_OUTPUT_H
#define AMONTONS_RUN_OUTPUT_H

#include "run/simulation_state.h"

bool output_check(const Scene *scene, Error *err);   // that this build can write it
bool output_open(Simulation *simulation, Error *err);   // history and fields
void output_warn_of_window(Simulation *simulation);   // where nothing lay in it
bool output_store_warnings(Simulation *simulation, Error *err);   // before the history's finish
bool output_draw_figures(Simulation *simulation, Error *err);   // from the finished history

// With the first step, and what was recorded so far on the disk, an earlier result may go.
bool output_begin_result(Simulation *simulation, Error *err);

#endif
