// SPDX-License-Identifier: GPL-2.0-or-later
// Reads a study's file. Called by sweep; study_add_designs by share, too.
#ifndef AMONTONS_STUDY_SWEEP_READING_STUDY_READ_H
#define AMONTONS_STUDY_SWEEP_READING_STUDY_READ_H

#include "study/sweep/reading/study.h"

// overrides: "key=value" as after --set, for every point; a key that is varied is refused. Values
// are checked when the scenes of the points are made (study_point).
// ERROR_INPUT: file:line:column, the key, what was found and what is allowed.
bool study_read(const char *path, const char *const *overrides, int32_t override_count,
                bool trusted, Study *study, Error *err);
// Adds further cases to a study that searches, from the list of maps in `text`.
bool study_add_designs(Study *study, const char *text, Error *err);

#endif
