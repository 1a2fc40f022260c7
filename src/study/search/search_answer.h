// SPDX-License-Identifier: GPL-2.0-or-later
// What every search leaves beside its tables: its answer in words, and the best design's scene.
// Called by optimise_report and fit_report.
#ifndef AMONTONS_STUDY_SEARCH_SEARCH_ANSWER_H
#define AMONTONS_STUDY_SEARCH_SEARCH_ANSWER_H

#include "study/search/search.h"

// What is written to `out` in between goes to options->out (NULL: nowhere) and to DIR/answer.txt.
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
