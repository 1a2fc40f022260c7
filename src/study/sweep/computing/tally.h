// SPDX-License-Identifier: GPL-2.0-or-later
// Counts points as they end, and reports each to the caller (options->on_point). Called by sweep,
// and by pool and slurm, which compute points.
#ifndef AMONTONS_STUDY_SWEEP_COMPUTING_TALLY_H
#define AMONTONS_STUDY_SWEEP_COMPUTING_TALLY_H

#include "study/sweep/computing/point.h"

// Points from `first` on that an earlier sweep finished: computed again only where the options say
// so.
bool sweep_take_finished(Sweep *sweep, int32_t first, Error *err);
bool sweep_is_waiting(const Sweep *sweep, int32_t point);   // to be computed, by itself
// ERROR_INTERRUPT once options->stop is set.
bool sweep_check_stop(const Sweep *sweep, Error *err);
// The process of `point` has ended: its report is counted and reported. seconds: it took;
// NaN: as in run.json. *left: whether there is a run.json.
bool sweep_take_ended(Sweep *sweep, int32_t point, double seconds, bool *left, Error *err);
// The same of one that left none: first the report of its failure is written, `failure` in a word
// or two, `message` in full.
bool sweep_take_lost(Sweep *sweep, int32_t point, double seconds, const char *failure,
                     const char *message, Error *err);
// Is called when all are computed: points with the same scene get the status of the first of them.
void sweep_share_results(Sweep *sweep);
void sweep_summarise(const Sweep *sweep, SweepSummary *summary);

#endif
