// SPDX-License-Identifier: GPL-2.0-or-later
// Points of a study in the order of one result. Made by study/sweep/showing/rank.
#ifndef AMONTONS_STUDY_SWEEP_SHOWING_RANKING_H
#define AMONTONS_STUDY_SWEEP_SHOWING_RANKING_H

#include <stdbool.h>
#include <stdint.h>

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
    // So many points were computed again with smaller bars (study/sweep/refine), and moved by up to
    // so many of their bars before. Where that is more than 1 those of the others count as so
    // many times as long: what coarse meshes have in common would else stand on one side alone.
    int32_t refined;
    double moved;
    double base;   // the value that gains are measured from; NaN: each row has its own
} Ranking;

#endif
