// SPDX-License-Identifier: GPL-2.0-or-later
// figures/ranking.png and figures/plot.png, drawn by the module `render`.
#ifndef AMONTONS_STUDY_SWEEP_FIGURES_H
#define AMONTONS_STUDY_SWEEP_FIGURES_H

#include "study/sweep/rank.h"

bool figure_of_ranking(const Sweep *sweep, const SweepTable *table, const Ranking *ranking,
                       Error *err);
bool figure_of_plot(const Sweep *sweep, const SweepTable *table, Error *err);

#endif
