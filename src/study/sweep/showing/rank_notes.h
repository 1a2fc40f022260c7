// SPDX-License-Identifier: GPL-2.0-or-later
// Says in a few words what makes a value or its rank doubtful. Called by study/sweep/showing/rank.
#ifndef AMONTONS_STUDY_SWEEP_SHOWING_RANK_NOTES_H
#define AMONTONS_STUDY_SWEEP_SHOWING_RANK_NOTES_H

#include "study/sweep/showing/ranking.h"
#include "study/sweep/showing/table.h"

enum { RANK_NOTE_SIZE = 120 };

bool rank_notes(const Sweep *sweep, const Ranking *ranking, const RankRow *row,
                char note[RANK_NOTE_SIZE], Error *err);

#endif
