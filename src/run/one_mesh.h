// SPDX-License-Identifier: GPL-2.0-or-later
// Error that the mesh of one run leaves, as far as this run tells it. Called by run/simulation for
// a run that stands alone, and by run/accuracy_member for those behind an error bar.
#ifndef AMONTONS_RUN_ONE_MESH_H
#define AMONTONS_RUN_ONE_MESH_H

#include "answers/error_bars.h"
#include "run/simulation_state.h"

// Contact nodes, and whether cells are too long for slip.
void one_mesh_read(const Simulation *simulation, Level *level);
// Sets how far the answers of this run alone are known.
void one_mesh_answer(const Simulation *simulation, Answers *answers);

// Increase of mu by the last nodes of the contact. Slow slip grows from the trailing end; where its
// front comes to the last nodes of the leading end before the block slides, these hold the block
// while mu rises. The rise depends on their size: shorter cells let go sooner
// (validation/paper/README.md). The rise from when the front comes to them until the block slides
// is an error of the mesh. In space a row of nodes lets go one by one, and bars hold without this
// (validation/space/priors.md). Watched after each step.
//
// Zeroed before the first step, but for mu and passed: NaN.
typedef struct EndWait {
    double mu;   // when the front came to the last nodes, since the last fall; NaN: it has not
    double passed;   // when it had come past them
    double rise;   // sum over bulk slidings
    int32_t slidings;   // all but the first
} EndWait;

void end_wait_watch(EndWait *wait, const Simulation *simulation);

// Mean rise of mu, where the front of slip comes to the last nodes (critical_length: the mean l_c,
// length) and the block slides as soon as it comes past them. 0: it does not; several pads; in
// space.
double end_wait_of(const EndWait *wait, const Interface *interface, double critical_length);

#endif
