// SPDX-License-Identifier: GPL-2.0-or-later
// States that a run had, oldest first, for run/rewind. They are part of a checkpoint.
#ifndef AMONTONS_RUN_KEPT_STATES_H
#define AMONTONS_RUN_KEPT_STATES_H

#include "amontons_simulation.h"
#include "base/archive.h"
#include "record/window.h"

enum { KEPT_STATES_MAX = WINDOW_SLIDINGS_MAX + 1 };

typedef struct KeptStates {
    int32_t count;
    double times[KEPT_STATES_MAX];
    SavedState states[KEPT_STATES_MAX];   // owned
} KeptStates;

void kept_states_destroy(KeptStates *kept);   // none are left; zeroed is fine
bool kept_states_archive(KeptStates *kept, Archive *archive, Error *err);

#endif
