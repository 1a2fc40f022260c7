// SPDX-License-Identifier: GPL-2.0-or-later
// A study's points in the order of one result: ranking.csv, and its first rows on the terminal.
#ifndef AMONTONS_STUDY_SWEEP_RANK_H
#define AMONTONS_STUDY_SWEEP_RANK_H

#include "study/sweep/table.h"

typedef struct RankRow {
    int32_t point;
    double value, low, high;   // what it is ranked by; bounds of mu_M or mu_trusted, else NaN
    double gain;   // over the baseline, 1; NaN: there is none
    bool as_good;   // its bounds meet those of the best
} RankRow;

typedef struct Ranking {
    RankRow *rows;   // [count] the best first; points without a value last; owned
    int32_t count, ranked;   // all points; those with a value
} Ranking;

bool ranking_make(const Sweep *sweep, const SweepTable *table, Ranking *ranking, Error *err);
bool ranking_write(const Sweep *sweep, const SweepTable *table, const Ranking *ranking, Error *err);
// The first rows, as many as `rank` says, to options->out.
bool ranking_print(const Sweep *sweep, const SweepTable *table, const Ranking *ranking, Error *err);
void ranking_destroy(Ranking *ranking);   // zeroed is fine

#endif
