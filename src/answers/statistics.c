// SPDX-License-Identifier: GPL-2.0-or-later
// The rule of repetition. A series has period p when its last 2 p + 1 items agree, each with the
// last one at its place in the round (two whole rounds and the item that begins the third, so that
// a slow drift does not pass), and when those are a third of the series or more. The first item is
// the start's and never counts. If two items agree by chance with probability q, this many do with
// q^(p + 1): period 1 is the likeliest mistake, q^2. Three rounds of every period, q^(2p), would
// hardly be safer in sum (q = 0.1: 0.010 instead of 0.011 for each item) and would cost p - 1 more
// items, a cycle of stick and slip each. In a long series a few items agree by chance sooner or
// later: hence the third.
//
// Errors: that of independent rounds with Student's factor, lengthened by the correlation r of
// neighbours, sqrt((1 + r) / (1 - r)) of a series of first order; and by batch means, which tend to
// the error whatever the correlation as N grows: sqrt(N) blocks of sqrt(N) successive rounds
// (Flegal & Jones, Ann. Stat. 38, 2010). The larger of both. Of 30 items of a series with r = 0.5
// bars by batch means alone hold in 86 of 100, by both in 92 (of independent ones in 96 and 97);
// Student's factor for blocks would hold in 93, and be 1.4 times as long for independent items, 6
// times for 8 of them. Quantiles are interpolated between order statistics; the error of a quantile
// is that of the share of items below it, read off the same curve.
#include "answers/statistics.h"

#include <math.h>
#include <stdlib.h>

enum { ROUNDS = 2, REPEATING_PART = 3 };
enum { NEARER = 2 };   // so many times, for a period above 1
enum { START_PART = 4 };   // without a period, the first of so many parts is the start's
static const double LOWEST = 0.1;
enum { CORRELATED = 5 };   // so few rounds tell nothing of how they go along
static const double CORRELATION_MAX = 0.95;

// --- repetition ---------------------------------------------------------------------------------

static double distance(const SeriesItem *a, const SeriesItem *b, int32_t parts)
{
    double moved = fabs(a->value - b->value);
    for (int32_t j = 0; j < parts; j++) moved += fabs(a->state[j] - b->state[j]);
    return moved;
}

SeriesRegime series_regime(const SeriesItem *items, int32_t count, double tolerance, int32_t parts)
{
    int32_t last = count - 1;
    for (int32_t period = 1; period <= SERIES_PERIOD_LIMIT; period++) {
        // The last items that agree with the last one at their place in a round; at least `period`.
        // The parts of a load may change by twice the tolerance in sum: a change leaves one part
        // and appears in another.
        int32_t agreeing = period;
        for (int32_t k = last - period; k >= 1; k--) {
            const SeriesItem *item = &items[k], *later = &items[last - (last - k) % period];
            double allowed = tolerance * fabs(later->value), moved = 0;
            for (int32_t j = 0; j < parts; j++) moved += fabs(item->state[j] - later->state[j]);
            if (item->kind != later->kind || fabs(item->value - later->value) > allowed) break;
            if (!(moved <= 2 * allowed)) break;
            agreeing++;
        }
        if (agreeing <= ROUNDS * period || REPEATING_PART * agreeing < count) continue;

        // A round in which all items are alike within the tolerance repeats by chance: what comes
        // back at its place must be nearer than neighbours are.
        double back = 0, next = 0;
        for (int32_t k = last - period; k < count && period > 1 && parts > 0; k++) {
            back += distance(&items[k], &items[k - period], parts);
            next += distance(&items[k], &items[k - 1], parts);
        }
        if (NEARER * back <= next)
            return (SeriesRegime){.period = period, .count = agreeing - agreeing % period};
    }
    int32_t start = count / START_PART;
    if (start == 0 && count > 1) start = 1;
    return (SeriesRegime){.count = count - start};
}

// --- mean and decile ----------------------------------------------------------------------------

double student(int32_t freedoms)
{
    static const double by_freedoms[] = {12.71, 4.30, 3.18, 2.78, 2.57, 2.45, 2.36, 2.31, 2.26,
                                         2.23,  2.20, 2.18, 2.16, 2.14, 2.13, 2.12, 2.11, 2.10};
    const int32_t known = sizeof by_freedoms / sizeof *by_freedoms;
    if (freedoms < 1) return INFINITY;
    return freedoms <= known ? by_freedoms[freedoms - 1] : 1.96 + 2.5 / freedoms;
}

typedef struct Sample {
    const SeriesItem *items;
    int32_t count;
    double threshold;   // NaN: of the values themselves; else of 1 where a value is at most this
} Sample;

static double value(const Sample *sample, int32_t k)
{
    double x = sample->items[k].value;
    return isnan(sample->threshold) ? x : (x <= sample->threshold);
}

// The mean of `blocks` means of `length` successive values each, the last ones of the sample, and
// its standard error as if those means were independent (NaN for one block).
static Estimate block_mean(const Sample *sample, int32_t blocks, int32_t length)
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
    return (Estimate){mean, blocks > 1 ? sqrt(square / (blocks - 1) / blocks) : (double)NAN};
}

// Ratio of an error to that of `count` independent values. It follows from the correlation of
// neighbours, which is taken as 0 at least and corrected where few values leave it too small.
// product, square: sums of deviations times the one before, and of their squares.
static double lengthening(int32_t count, double product, double square)
{
    if (count < CORRELATED || square == 0) return 1;
    double along = fmin(fmax((count * product / square + 1) / (count - 3), 0), CORRELATION_MAX);
    return sqrt((1 + along) / (1 - along));
}

// A round tells its scatter at each of its places: so many degrees of freedom.
static Estimate mean_of(const Sample *sample, int32_t round)
{
    int32_t rounds = sample->count / round, blocks = (int32_t)sqrt(rounds);
    Estimate mean = block_mean(sample, rounds, round);
    if (rounds < 2) return mean;

    double before = 0, square = 0, product = 0;   // of each mean of a round with the one before
    for (int32_t b = 0; b < rounds; b++) {
        Sample until = *sample;
        until.count -= (rounds - 1 - b) * round;
        double off = block_mean(&until, 1, round).value - mean.value;
        square += off * off;
        product += off * before;
        before = off;
    }
    mean.error *= lengthening(rounds, product, square) * student(sample->count - round) / 2;
    if (blocks > 1)
        mean.error = fmax(mean.error, block_mean(sample, blocks, rounds / blocks * round).error);
    return mean;
}

Estimate series_mean(const SeriesItem *items, int32_t count, int32_t round)
{
    if (count < 1) return (Estimate){NAN, NAN};
    return mean_of(&(Sample){items, count, NAN}, round);
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

// The error is half the range that holds the decile with 68 % confidence.
Estimate series_lowest_decile(const SeriesItem *items, int32_t count)
{
    Sample sample = {items, count, NAN};
    Estimate decile = {NAN, NAN};
    if (count < 1) return decile;
    decile.value = quantile(&sample, LOWEST);
    if (count < 2) return decile;
    double error = mean_of(&(Sample){items, count, decile.value}, 1).error;
    decile.error = (quantile(&sample, LOWEST + error) - quantile(&sample, LOWEST - error)) / 2;
    return decile;
}

// --- trend --------------------------------------------------------------------------------------

static double mean_of_items(const SeriesItem *items, int32_t count)
{
    double sum = 0;
    for (int32_t k = 0; k < count; k++) sum += items[k].value;
    return sum / count;
}

// Sums over values about their mean: x is the number of the item.
typedef struct TrendSums {
    double xx, xy, yy;
} TrendSums;

// Adds `count` values, `apart` items from one to the next.
static void add_values(const double *values, int32_t count, int32_t apart, TrendSums *sums)
{
    double mean = 0;
    for (int32_t k = 0; k < count; k++) mean += values[k] / count;
    for (int32_t k = 0; k < count; k++) {
        double x = apart * (k - 0.5 * (count - 1)), y = values[k] - mean;
        sums->xx += x * x;
        sums->xy += x * y;
        sums->yy += y * y;
    }
}

enum { TREND_VALUES = 64 };   // the last of them tell a trend

static SeriesTrend trend_of(const TrendSums *sums, int32_t freedoms)
{
    double slope = sums->xx > 0 ? sums->xy / sums->xx : 0;
    double left = fmax(sums->yy - slope * sums->xy, 0);
    return (SeriesTrend){slope, freedoms > 0 ? sqrt(left / freedoms / sums->xx) : (double)NAN,
                         freedoms};
}

bool series_trend_stands_out(const SeriesTrend *trend)
{
    return fabs(trend->slope) > student(trend->freedoms) * trend->error;   // false of NaN
}

// One of `looked_at` trends stands out by chance as often as a single one does by Student's factor
// times sqrt(looked_at), at most.
static bool stands_out_among(SeriesTrend trend, int32_t looked_at)
{
    trend.error *= sqrt(looked_at);
    return series_trend_stands_out(&trend);
}

// The trend of values that need not be independent: neighbours lengthen its error as they lengthen
// that of a mean.
static SeriesTrend trend_of_neighbours(const double *values, int32_t count)
{
    TrendSums sums = {0};
    add_values(values, count, 1, &sums);
    SeriesTrend trend = trend_of(&sums, count - 2);
    double mean = 0, before = 0, square = 0, product = 0;
    for (int32_t k = 0; k < count; k++) mean += values[k] / count;
    for (int32_t k = 0; k < count; k++) {
        double off = values[k] - mean - trend.slope * (k - 0.5 * (count - 1));
        square += off * off;
        product += off * before;
        before = off;
    }
    trend.error *= lengthening(count, product, square);
    return trend;
}

SeriesTrend series_trend(const SeriesItem *items, int32_t count, int32_t round)
{
    double values[TREND_VALUES] = {0};
    if (round == 0) {
        int32_t used = count < TREND_VALUES ? count : TREND_VALUES;
        const SeriesItem *first = items + count - used;
        double mean = mean_of_items(first, used);
        for (int32_t k = 0; k < used; k++) values[k] = first[k].value;
        SeriesTrend level = trend_of_neighbours(values, used);
        for (int32_t k = 0; k < used; k++) values[k] = fabs(values[k] - mean);
        SeriesTrend scatter = trend_of_neighbours(values, used);
        bool grows = scatter.slope > 0 && stands_out_among(scatter, 2);
        bool steeper = !series_trend_stands_out(&level) || scatter.slope > fabs(level.slope);
        return grows && steeper ? scatter : level;
    }
    SeriesTrend place_trend[SERIES_PERIOD_LIMIT];
    TrendSums all = {0};
    int32_t used = 0;
    for (int32_t place = 0; place < round; place++) {
        int32_t found = 0;
        TrendSums own = {0};
        for (int32_t k = count - 1 - place; k >= 0 && found < TREND_VALUES; k -= round)
            values[found++] = items[k].value;
        add_values(values, found, -round, &own);
        place_trend[place] = trend_of(&own, found - 2);
        all.xx += own.xx, all.xy += own.xy, all.yy += own.yy;
        used += found;
    }
    SeriesTrend trend = trend_of(&all, used - round - 1);
    double steepest = series_trend_stands_out(&trend) ? fabs(trend.slope) : 0;
    for (int32_t place = 0; place < round; place++) {
        const SeriesTrend *own = &place_trend[place];
        if (!stands_out_among(*own, round) || fabs(own->slope) <= steepest) continue;
        trend = *own;
        steepest = fabs(own->slope);
    }
    return trend;
}

double series_fading(const SeriesItem *items, int32_t third)
{
    double first = mean_of_items(items, third), middle = mean_of_items(items + third, third);
    return (mean_of_items(items + 2 * third, third) - middle) / (middle - first);
}

// --- branches -----------------------------------------------------------------------------------

static int compare(const void *left, const void *right)
{
    const SeriesItem *a = left, *b = right;
    if (a->kind != b->kind) return a->kind < b->kind ? -1 : 1;
    return (a->value > b->value) - (a->value < b->value);
}

void series_sort(SeriesItem *items, int32_t count)
{
    if (count > 0) qsort(items, (size_t)count, sizeof *items, compare);   // of none: NULL
}

// Single linkage: a branch goes on as long as the next value is within the tolerance of its
// highest. An infinite tolerance makes one branch of each kind.
int32_t series_branch(const SeriesItem *sorted, int32_t count, int32_t from, double tolerance,
                      SeriesBranch *branch)
{
    const SeriesItem *first = &sorted[from];
    double sum = 0;
    int32_t k = from;
    *branch = (SeriesBranch){.low = first->value, .high = first->value, .kind = first->kind};
    for (; k < count && sorted[k].kind == first->kind; k++) {
        double reach = branch->high + tolerance * fabs(branch->high);
        if (sorted[k].value > reach) break;
        branch->high = sorted[k].value;
        sum += sorted[k].value;
    }
    branch->count = k - from;
    branch->mean = sum / branch->count;
    return k;
}
