// SPDX-License-Identifier: GPL-2.0-or-later
// Looks up what a study records in the first run.json there is: a mistyped path must not cost a
// whole sweep. run.json has no schema in which to look it up before. Called by tally.
#ifndef AMONTONS_STUDY_SWEEP_COMPUTING_RECORD_CHECK_H
#define AMONTONS_STUDY_SWEEP_COMPUTING_RECORD_CHECK_H

#include "study/sweep/reading/study.h"

// report: run.json of a run that is done. ERROR_INPUT: a path that no such file has, at its place
// in the study.
bool record_check(const Study *study, const char *report, Error *err);

#endif
