// SPDX-License-Identifier: GPL-2.0-or-later
// Figures of a fit. Called by fit_report.
#ifndef AMONTONS_STUDY_SEARCH_FIT_FIGURES_H
#define AMONTONS_STUDY_SEARCH_FIT_FIGURES_H

#include "study/search/fit_regions.h"

// figures/measured.png: found less measured; profile_KEY.png: the misfit along a key, least over
// the others; region_KEY_KEY.png: two keys together.
bool fit_figures(const Fit *fit, Error *err);

#endif
