// SPDX-License-Identifier: GPL-2.0-or-later
// Writes the report of a fit: words, fit.csv and figures. Called by fit.
#ifndef AMONTONS_STUDY_SEARCH_FIT_REPORT_H
#define AMONTONS_STUDY_SEARCH_FIT_REPORT_H

#include "study/search/fit_regions.h"

// Words to options->out; fit.csv has a row a measurement; figures: measured.png, course.png,
// profile_KEY.png, region_KEY_KEY.png.
bool fit_report(const Fit *fit, const FitSummary *summary, Error *err);

#endif
