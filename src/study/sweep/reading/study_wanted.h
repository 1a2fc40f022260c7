// SPDX-License-Identifier: GPL-2.0-or-later
// Reads the results that a study asks for: the columns of its table (`record`), the best of its
// points (`rank`) and figures (`plot`). Called by study_read, after study_vary, and by
// search/measurements.
#ifndef AMONTONS_STUDY_SWEEP_READING_STUDY_WANTED_H
#define AMONTONS_STUDY_SWEEP_READING_STUDY_WANTED_H

#include "study/sweep/reading/study.h"

bool study_read_wanted(Study *study, Error *err);
// The path in run.json of what `record` calls `name`; NULL: no name of its list, nor a path of
// results.
const char *study_record_path(const char *name);

#endif
