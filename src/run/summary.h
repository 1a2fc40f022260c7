// SPDX-License-Identifier: GPL-2.0-or-later
// What a run came to, in counts, answers and seconds: RunCounters, RunSummary and the phases that
// `amontons run --profile` prints. Called by run/simulation.
#ifndef AMONTONS_RUN_SUMMARY_H
#define AMONTONS_RUN_SUMMARY_H

#include "run/simulation.h"

RunCounters summary_count(const Simulation *simulation);
void summary_fill(const Simulation *simulation, const RunCounters *counters,
                  const PeaksSummary *peaks, RunSummary *summary);

#endif
