// SPDX-License-Identifier: GPL-2.0-or-later
// A study's points in the order of one result: ranking.csv, and its first rows on the terminal.
#ifndef AMONTONS_STUDY_SWEEP_SHOWING_RANK_H
#define AMONTONS_STUDY_SWEEP_SHOWING_RANK_H

#include "study/sweep/showing/ranking.h"
#include "study/sweep/showing/table.h"

bool ranking_make(const Sweep *sweep, const SweepTable *table, Ranking *ranking, Error *err);
bool ranking_write(const Sweep *sweep, const SweepTable *table, const Ranking *ranking, Error *err);
// The first rows, as many as `rank` says, to options->out.
bool ranking_print(const Sweep *sweep, const SweepTable *table, const Ranking *ranking, Error *err);
void ranking_destroy(Ranking *ranking);   // zeroed is fine

#endif
