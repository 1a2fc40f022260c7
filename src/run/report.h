// SPDX-License-Identifier: GPL-2.0-or-later
// run.json: what was asked, what was done, what came out with which errors. One object,
// written last, atomically.
#ifndef AMONTONS_RUN_REPORT_H
#define AMONTONS_RUN_REPORT_H

#include "run/simulation_state.h"

// Data of a report beside the simulation itself. Nothing is owned.
typedef struct RunReport {
    const Simulation *simulation;
    const Error *failure;   // NULL: done
    const RunCounters *counters;
    const Answers *answers;
    const Event *least_resolved;   // before which the fewest cells slipped; NULL: none
} RunReport;

bool report_write(const char *folder, const RunReport *report, Error *err);
// The same in memory (memory_free); NULL on failure. Paths in it are as seen from `folder`.
char *report_text(const char *folder, const RunReport *report, Error *err);

#endif
