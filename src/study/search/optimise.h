// SPDX-License-Identifier: GPL-2.0-or-later
// The report of a search for the best design, in words and figures, and the front of several aims:
// each point of `vary` is one. In the front are designs that no other is better than at one aim
// without being worse at another. Called by optimise.
#ifndef AMONTONS_STUDY_SEARCH_OPTIMISE_H
#define AMONTONS_STUDY_SEARCH_OPTIMISE_H

#include "amontons_optimise.h"
#include "study/search/search.h"

// Writes to options->out, and draws figures/course.png and along_KEY.png of the folder.
bool optimise_report(const Search *search, const OptimiseSummary *summary, Error *err);

bool pareto_front_holds(const Designs *designs, int32_t design);   // by values alone
// A line a design, by its value at the first aim, with its value and bar at each.
bool pareto_front_print(const Search *search, FILE *out, Error *err);
// figures/front.png: all designs, and the front, over the first two aims.
bool pareto_front_draw(const Search *search, Error *err);

#endif
