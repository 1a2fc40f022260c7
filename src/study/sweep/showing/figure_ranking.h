// SPDX-License-Identifier: GPL-2.0-or-later
// figures/ranking.png, drawn by the module `render`. Called by sweep.
#ifndef AMONTONS_STUDY_SWEEP_SHOWING_FIGURE_RANKING_H
#define AMONTONS_STUDY_SWEEP_SHOWING_FIGURE_RANKING_H

#include "study/sweep/showing/rank.h"

bool figure_of_ranking(const Sweep *sweep, const SweepTable *table, const Ranking *ranking,
                       Error *err);

#endif
