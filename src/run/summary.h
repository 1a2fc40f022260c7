// SPDX-License-Identifier: GPL-2.0-or-later
// Data for the caller of amontons.h: of an accepted step (StepView; also of study/line's), and at
// the end counts, answers and seconds: RunCounters and RunSummary. Called by run/simulation.
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
