// SPDX-License-Identifier: GPL-2.0-or-later
// A study's points in the order of one result: ranking.csv, and its first rows on the terminal and
// in figures/ranking.png.
#ifndef AMONTONS_STUDY_SWEEP_SHOWING_RANK_H
#define AMONTONS_STUDY_SWEEP_SHOWING_RANK_H

#include "study/sweep/showing/table.h"

typedef struct RankRow {
    int32_t point;
    double value;   // what it is ranked by
    double error;   // of it: the error bar, else what a mesh usually leaves; NaN
    double bar;   // error bar; NaN: none
    double gain, gain_error;   // over the baseline, 1; NaN: there is none, or not known
    int32_t from, to;   // ranks that it may have, given the errors; alike: it is decided
} RankRow;

typedef struct Ranking {
    RankRow *rows;   // [count] the best first; points without a value last; owned
    int32_t count, ranked;   // all points; those with a value
    bool has_error;   // the result has an error in run.json
    double base;   // the value that gains are measured from; NaN: each row has its own
} Ranking;

// Writes ranking.csv, and where the sweep was not stopped (`whole`) prints to `out` (NULL: nowhere)
// and draws the first rows, as many as `rank` says.
bool ranking_show(const Sweep *sweep, const SweepTable *table, FILE *out, bool whole, Error *err);
bool ranking_make(const Sweep *sweep, const SweepTable *table, Ranking *ranking, Error *err);
void ranking_destroy(Ranking *ranking);   // zeroed is fine

#endif
