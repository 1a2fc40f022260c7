// SPDX-License-Identifier: GPL-2.0-or-later
// What the mesh of one run tells of the error that it leaves. Called by run/simulation for a run
// that stands alone, and by run/accuracy_member for those behind an error bar.
#ifndef AMONTONS_RUN_ONE_MESH_H
#define AMONTONS_RUN_ONE_MESH_H

#include "record/error_bars.h"
#include "run/simulation_state.h"

// Contact nodes, and whether cells are too long for slip.
void one_mesh_read(const Simulation *simulation, Level *level);
// How far the answers of this run alone are known, from its mesh and from `least`, the load drop
// before which the fewest cells slipped (NULL: none).
void one_mesh_answer(const Simulation *simulation, const Event *least, Answers *answers);

#endif
