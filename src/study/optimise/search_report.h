// SPDX-License-Identifier: GPL-2.0-or-later
// What a search came to, in words and figures. Called by optimise.
#ifndef AMONTONS_STUDY_OPTIMISE_SEARCH_REPORT_H
#define AMONTONS_STUDY_OPTIMISE_SEARCH_REPORT_H

#include "study/optimise/search_state.h"

// To options->out, and figures/course.png and along_KEY.png of the folder.
bool search_report(const Search *search, const OptimiseSummary *summary, Error *err);

#endif
