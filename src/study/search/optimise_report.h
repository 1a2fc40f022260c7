// SPDX-License-Identifier: GPL-2.0-or-later
// Writes the report of a search, in words and figures. Called by optimise.
#ifndef AMONTONS_STUDY_SEARCH_OPTIMISE_REPORT_H
#define AMONTONS_STUDY_SEARCH_OPTIMISE_REPORT_H

#include "amontons_optimise.h"
#include "study/search/search.h"

// Writes to options->out, and draws figures/course.png and along_KEY.png of the folder.
bool optimise_report(const Search *search, const OptimiseSummary *summary, Error *err);

#endif
