// SPDX-License-Identifier: GPL-2.0-or-later
// Reads the keys of a study that searches: `search`, `where`, `best` and `fit`. Called by
// study_read.
#ifndef AMONTONS_STUDY_SWEEP_READING_STUDY_SEARCH_H
#define AMONTONS_STUDY_SWEEP_READING_STUDY_SEARCH_H

#include "study/sweep/reading/study.h"

// Fills study->search. ERROR_INPUT also where `cases` or `vary` gives a key that is searched.
bool study_read_search(Study *study, Error *err);

#endif
