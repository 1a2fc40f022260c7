// SPDX-License-Identifier: GPL-2.0-or-later
// Writes what every search leaves beside its tables: the answer in words and the scene of the best
// design. Called by optimise_report and fit_report.
#ifndef AMONTONS_STUDY_SEARCH_SEARCH_ANSWER_H
#define AMONTONS_STUDY_SEARCH_SEARCH_ANSWER_H

#include "study/search/search.h"

// Text that is written to `out` between begin and end goes to options->out (NULL: nowhere) and to
// DIR/answer.txt.
typedef struct SearchAnswer {
    FILE *out;
    char *text;
    size_t size;
} SearchAnswer;

bool search_answer_begin(SearchAnswer *answer, Error *err);
bool search_answer_end(const Search *search, SearchAnswer *answer, Error *err);
// A line if there were no further designs to compute.
void search_print_exhausted(const Search *search, FILE *out);
// DIR/best.yaml, a scene to be run, of a design at a condition; figures/best.png: its mesh and rod.
bool search_leave_best(const Search *search, int32_t design, int32_t condition, Error *err);

#endif
