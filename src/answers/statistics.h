// SPDX-License-Identifier: GPL-2.0-or-later
// Statistics of a series of numbers that comes to repeat itself with some period, or that stays
// random: which of its items belong to the regime that it has settled to, and what is known of
// their mean, of their lowest decile and of the values that they return to. Asked by
// answers/answers of drops of mu.
#ifndef AMONTONS_ANSWERS_STATISTICS_H
#define AMONTONS_ANSWERS_STATISTICS_H

#include "record/series.h"

#include <stdbool.h>

typedef struct SeriesRegime {
    int32_t period;   // items in a round; 0: they do not repeat
    int32_t count;   // the last items: whole rounds, or without a period all but the start's
} SeriesRegime;

// Items that agree; those of one kind whose values lie closer together than a tolerance.
typedef struct SeriesBranch {
    double low, mean, high;
    int32_t kind, count;
} SeriesBranch;

enum { SERIES_PERIOD_LIMIT = 8 };

// Two items agree within `tolerance`, relative to the later one, and so do the states, the sum over
// their parts within twice of it.
SeriesRegime series_regime(const SeriesItem *items, int32_t count, double tolerance, int32_t parts);

// Rise of values from item to item, by least squares about the mean of each place in the round: the
// trend of all places together, or the steeper one of a single place that stands out, as the two
// values of an alternation that grows go opposite ways. Where values do not repeat (`round` 0)
// their error is lengthened by the correlation of neighbours, and a scatter about their mean that
// grows is a trend, too.
typedef struct SeriesTrend {
    double slope, error;   // an item; one standard error
    int32_t freedoms;   // of the error; below 1: there is none
} SeriesTrend;
SeriesTrend series_trend(const SeriesItem *items, int32_t count, int32_t round);
// True if the trend differs from 0 by more than its scatter allows, by Student's 95 %.
bool series_trend_stands_out(const SeriesTrend *trend);

// Means are taken over three successive groups of `third` items. Returns the last difference of two
// neighbouring means, over the difference before it.
double series_fading(const SeriesItem *items, int32_t third);

// Half width of the 95 % confidence interval of a normal variable's mean, in standard errors that
// are estimated with so many degrees of freedom (Student's t); infinite below 1.
double student(int32_t freedoms);

// Estimates from `count` items in the order in which they came. They are whole rounds of `round`
// items each; 1: they do not repeat.
Estimate series_mean(const SeriesItem *items, int32_t count, int32_t round);
Estimate series_lowest_decile(const SeriesItem *items, int32_t count);

// Sorts by kind, then by value. series_branch finds the items from `from` on that make a branch,
// and returns the index at which the next one begins.
void series_sort(SeriesItem *items, int32_t count);
int32_t series_branch(const SeriesItem *sorted, int32_t count, int32_t from, double tolerance,
                      SeriesBranch *branch);

#endif
