// SPDX-License-Identifier: GPL-2.0-or-later
// What the caller of amontons.h is shown: of an accepted step (StepView; of study/line's too), and
// at the end counts, answers and seconds: RunCounters, RunSummary and the phases that `amontons run
// --profile` prints. Called by run/simulation.
#ifndef AMONTONS_RUN_SUMMARY_H
#define AMONTONS_RUN_SUMMARY_H

#include "run/simulation_state.h"

// t_end: when the scene ends, time.
StepView step_view(const Observation *seen, const Events *events, const ContactArrays *contact,
                   double t_end);
RunSummary summary_none(void);   // of a run that has no answers yet
RunCounters summary_count(const Simulation *simulation);
void summary_fill(const Simulation *simulation, const RunCounters *counters, const Answers *answers,
                  RunSummary *summary);

#endif
