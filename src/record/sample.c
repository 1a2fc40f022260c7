// SPDX-License-Identifier: GPL-2.0-or-later
// Errors by batch means: sqrt(N) blocks of sqrt(N) successive items each. As N grows blocks get
// longer than any memory of the series and more numerous, so the spread of their means, over the
// root of their number, tends to the standard error of the mean whatever the correlation
// (Flegal & Jones, Ann. Stat. 38, 2010). With few blocks it is itself uncertain; it is never taken
// smaller than that of independent items. Quantiles are interpolated between order statistics;
// the error of a quantile is that of the share of items below it, read off the same curve.
#include "record/sample.h"

#include <math.h>

static const double LOWEST = 0.1;

typedef struct Sample {
    const void *series;   // not owned
    SampleItem *item;
    int32_t first, count;
    double threshold;   // NaN: of the items themselves; else of 1 where an item is at most this
} Sample;

static double value(const Sample *sample, int32_t k)
{
    double x = sample->item(sample->series, sample->first + k);
    return isnan(sample->threshold) ? x : (x <= sample->threshold);
}

// The mean of `blocks` means of `length` successive values each, the last ones of the sample, and
// its standard error as if those means were independent (NaN for one block).
static double block_mean(const Sample *sample, int32_t blocks, int32_t length, double *error)
{
    double mean = 0, square = 0;
    for (int32_t b = 0; b < blocks; b++) {
        double sum = 0;
        for (int32_t k = sample->count - (b + 1) * length; k < sample->count - b * length; k++)
            sum += value(sample, k);
        double step = sum / length - mean;
        mean += step / (b + 1);
        square += step * (sum / length - mean);
    }
    *error = blocks > 1 ? sqrt(square / (blocks - 1) / blocks) : (double)NAN;
    return mean;
}

static double mean_of(const Sample *sample, double *error)
{
    int32_t blocks = (int32_t)sqrt(sample->count);
    double by_blocks = NAN;
    double mean = block_mean(sample, sample->count, 1, error);
    if (blocks > 1) block_mean(sample, blocks, sample->count / blocks, &by_blocks);
    *error = fmax(*error, by_blocks);   // fmax of NaN and a number is the number
    return mean;
}

// The value with `rank` values before it in ascending order. Counts instead of sorting: no memory.
static double order_statistic(const Sample *sample, int32_t rank)
{
    for (int32_t k = 0; k < sample->count; k++) {
        int32_t less = 0, equal = 0;
        double x = value(sample, k);
        for (int32_t j = 0; j < sample->count; j++) {
            less += value(sample, j) < x;
            equal += value(sample, j) == x;
        }
        if (less <= rank && rank < less + equal) return x;
    }
    return NAN;
}

static double quantile(const Sample *sample, double share)
{
    double place = fmin(fmax(share, 0), 1) * (sample->count - 1);
    int32_t below = (int32_t)place;
    double part = place - below, low = order_statistic(sample, below);
    return part > 0 ? low + part * (order_statistic(sample, below + 1) - low) : low;
}

SampleSummary sample_summarise(const void *series, SampleItem *item, int32_t first, int32_t count)
{
    SampleSummary summary = {NAN, NAN, NAN, NAN};
    Sample sample = {series, item, first, count, NAN};
    if (count < 1) return summary;
    summary.mean = mean_of(&sample, &summary.mean_error);
    summary.decile = quantile(&sample, LOWEST);
    if (count < 2) return summary;
    Sample below = sample;
    below.threshold = summary.decile;
    double share_error;
    mean_of(&below, &share_error);
    summary.decile_error =
        (quantile(&sample, LOWEST + share_error) - quantile(&sample, LOWEST - share_error)) / 2;
    return summary;
}
