// SPDX-License-Identifier: GPL-2.0-or-later
// A fit under way, and how well each key is known. Shared by fit, fit_regions, fit_report.
#ifndef AMONTONS_STUDY_SEARCH_FIT_H
#define AMONTONS_STUDY_SEARCH_FIT_H

#include "amontons_optimise.h"
#include "study/search/measurements.h"
#include "study/search/response.h"
#include "study/search/search.h"

// The region of a key: where the misfit, the least over all other keys, is at most `most`.
typedef struct Region {
    double low, high;   // scaled
    bool low_open, high_open;   // an end of the range
    double low_place[STUDY_SEARCH_MAX], high_place[STUDY_SEARCH_MAX];   // of all keys, there
} Region;

typedef struct Fit {
    Search search;
    Measurements measured;   // owned, as all below
    double *found, *own;   // [DESIGNS_MAX][measured.count] of each design, and its error
    Response response;
    double best[STUDY_SEARCH_MAX];   // scaled
    double misfit;   // there
    double widened;   // regions: the root of misfit over what is to be expected, at least 1
    Region regions[STUDY_SEARCH_MAX];
} Fit;

double fit_scaled(const Fit *fit, int32_t k, double value);   // 0 to 1 over the range of key k
double fit_unscaled(const Fit *fit, int32_t k, double scaled);
// Bound of the misfit, above its least value, for the region of one key or of two keys together.
double fit_threshold(const Fit *fit, int32_t keys);
double fit_errors_off(const Fit *fit, int32_t datum);   // found less measured, over both errors
int32_t fit_freedom(const Fit *fit);   // measurements less keys
// Walks from the best point along `ray`, [keys], as far as the misfit, the least over the keys that
// it leaves out, is at most `most`. place: of all keys, there. Returns true if the range ends
// before.
bool fit_walk(const Fit *fit, const double *ray, double most, double *place);
// Finds the regions of all keys from the responses near the best point. *stays: no end has moved by
// more than a part of its region.
void fit_find_regions(Fit *fit, bool *stays);
// Writes words to options->out, fit.csv with a row a measurement, and the figures measured.png,
// course.png, profile_KEY.png and region_KEY_KEY.png.
bool fit_report(const Fit *fit, const FitSummary *summary, Error *err);

#endif
