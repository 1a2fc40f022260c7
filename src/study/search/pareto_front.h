// SPDX-License-Identifier: GPL-2.0-or-later
// Several aims at once: each point of `vary` is one. The front: designs that no other is better
// than at one aim without being worse at another. Called by optimise_report.
#ifndef AMONTONS_STUDY_SEARCH_PARETO_FRONT_H
#define AMONTONS_STUDY_SEARCH_PARETO_FRONT_H

#include "study/search/search.h"

bool pareto_front_holds(const Designs *designs, int32_t design);   // by values alone
// A line a design, by its value at the first aim, with its value and bar at each.
bool pareto_front_print(const Search *search, FILE *out, Error *err);
// figures/front.png: all designs, and the front, over the first two aims.
bool pareto_front_draw(const Search *search, Error *err);

#endif
