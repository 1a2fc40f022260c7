// SPDX-License-Identifier: GPL-2.0-or-later
// A value that is read off steps with its error, and an item of a series of such values. Whether a
// series repeats itself, and its mean, are asked in answers/statistics.
#ifndef AMONTONS_RECORD_SERIES_H
#define AMONTONS_RECORD_SERIES_H

#include <stdint.h>

typedef struct SeriesItem {
    double value;
    int32_t kind;   // items of different kinds never agree
    const double *state;   // what the value is a sum of, [parts]; NULL where nobody asks
} SeriesItem;

typedef struct Estimate {
    double value;   // NaN: not known
    double error;   // half of what it is off by at most, 95 %; NaN: not known
} Estimate;

#endif
