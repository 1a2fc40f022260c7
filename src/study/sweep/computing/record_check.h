// SPDX-License-Identifier: GPL-2.0-or-later
// What a study records is looked up in the first run.json there is: a mistyped path must not cost a
// whole sweep. Called by tally. run.json has no schema to look it up in before.
#ifndef AMONTONS_STUDY_SWEEP_COMPUTING_RECORD_CHECK_H
#define AMONTONS_STUDY_SWEEP_COMPUTING_RECORD_CHECK_H

#include "study/sweep/reading/study.h"

// report: run.json of a run that is done. ERROR_INPUT: a path that no such file has, at its place
// in the study.
bool record_check(const Study *study, const char *report, Error *err);

#endif
