// SPDX-License-Identifier: GPL-2.0-or-later
// A search under way. Shared by optimise and search_report.
#ifndef AMONTONS_STUDY_OPTIMISE_SEARCH_STATE_H
#define AMONTONS_STUDY_OPTIMISE_SEARCH_STATE_H

#include "study/optimise/chooser.h"
#include "study/optimise/designs.h"

typedef struct Search {
    const SweepOptions *options;   // not owned
    Study study;   // owned, as all below
    Designs designs;
    Scene *scene;   // of one design
    const ChooserModule *module;
    Chooser *chooser;
    int32_t start;   // design of the scene as it is; -1: none
    double accuracy;   // accuracy.mu of the study; 0: none
    int32_t side_by_side;   // designs of a round
    int32_t planned, told, computed;   // points: expected, shown, computed
    double started;   // wall clock, s
    bool begun;   // a round was computed
    int64_t told_of;   // point that decides for the best; -1: not yet known
    char run[AMONTONS_PATH_SIZE];   // run.json of that; "": it left none
} Search;

#endif
