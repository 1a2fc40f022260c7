// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/schedule.h"

#include <math.h>

// A point as near as this, relative, has been reached: steps end at points up to rounding.
static const double REACHED = 1e-12;

// nearly: x up to rounding, on the side that is asked for.
static int32_t find_segment(const Schedule *schedule, double nearly, double *from)
{
    double period = schedule->at[schedule->count - 1];
    *from = schedule->repeats ? period * floor(nearly / period) : 0;
    int32_t k = 0;
    while (k + 1 < schedule->count && schedule->at[k + 1] <= nearly - *from) k++;
    return k;
}

int32_t schedule_segment(const Schedule *schedule, double x, double *from)
{
    return find_segment(schedule, x * (1 - REACHED), from);
}

double schedule_factor(const Schedule *schedule, double x)
{
    double from;
    if (schedule->count == 0) return 1;
    int32_t k = schedule_segment(schedule, x, &from);
    const double *at = schedule->at, *factor = schedule->factor;
    if (k + 1 == schedule->count) return factor[k];
    double part = fmax((x - from - at[k]) / (at[k + 1] - at[k]), 0);
    return factor[k] + part * (factor[k + 1] - factor[k]);
}

double schedule_next(const Schedule *schedule, double x)
{
    double from;
    if (schedule->count == 0) return INFINITY;
    int32_t k = find_segment(schedule, x * (1 + REACHED), &from);
    return k + 1 < schedule->count ? from + schedule->at[k + 1] : INFINITY;
}

double schedule_largest(const Schedule *schedule)
{
    double largest = schedule->count == 0 ? 1 : 0;
    for (int32_t k = 0; k < schedule->count; k++)
        largest = fmax(largest, fabs(schedule->factor[k]));
    return largest;
}
