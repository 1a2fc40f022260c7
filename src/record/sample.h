// SPDX-License-Identifier: GPL-2.0-or-later
// Mean and lowest decile of a stationary series, each with its standard error: record/falls asks it
// of falls that do not repeat. Both settle as the series grows; its smallest item goes on falling.
#ifndef AMONTONS_RECORD_SAMPLE_H
#define AMONTONS_RECORD_SAMPLE_H

#include <stdint.h>

typedef double SampleItem(const void *series, int32_t k);

typedef struct SampleSummary {
    double mean, mean_error;   // one standard error; NaN: fewer than two items
    double decile;   // one item in ten is smaller; NaN: no item
    double decile_error;   // half the range that holds it with 68 % confidence
} SampleSummary;

// Of items first ... first + count - 1, in the order in which they came.
SampleSummary sample_summarise(const void *series, SampleItem *item, int32_t first, int32_t count);

#endif
