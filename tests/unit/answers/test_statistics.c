// SPDX-License-Identifier: GPL-2.0-or-later
// Series of letters, whose periods are told by eye; of random ones, which repeat by chance as often
// as combinatorics says; and of numbers whose mean, decile and errors are known: an arithmetic
// series, a constant, and an autoregressive series of first order, whose mean has
// sqrt((1 + a) / (1 - a)) times the error of independent items.
#include "answers/statistics.h"

#include "near.h"
#include "random_numbers.h"

enum { LONG = 4096 };

static SeriesItem items[LONG];

static void set_values(const double *values, int32_t count)
{
    for (int32_t k = 0; k < count; k++) items[k] = (SeriesItem){.value = values[k]};
}

// --- repetition ---------------------------------------------------------------------------------

// Values are a letter's place in the alphabet, in hundreds: neighbours differ by 1 to 50 per cent.
static void expect(const char *letters, int32_t period, int32_t counted)
{
    int32_t count = (int32_t)strlen(letters);
    for (int32_t k = 0; k < count; k++) items[k] = (SeriesItem){.value = 100 * (letters[k] - '`')};
    SeriesRegime found = series_regime(items, count, 1e-3, 0);
    if (found.period != period || found.count != counted)
        fail_msg("%s: period %d of %d items", letters, found.period, found.count);
}

TEST(test_periods)
{
    expect("xaaa", 1, 3);
    expect("aaa", 0, 2);   // the first item is the start's in any case
    expect("aaaa", 1, 3);
    expect("xabaaa", 1, 3);
    expect("xabab", 0, 4);
    expect("xababa", 2, 4);   // two whole rounds; the item that begins the third completes none
    expect("xbababa", 2, 6);
    expect("xccababa", 2, 4);
    expect("xabcabca", 3, 6);
    expect("xaabaaba", 3, 6);
    expect("xabcdefghabcdefgha", 8, 16);
    expect("xabcdefghiabcdefghia", 0, 15);   // nine is more than is looked for
}

// Drops that repeat must be a third of all; without a period the first quarter is the start's.
TEST(test_share)
{
    expect("abcdefaaa", 1, 3);
    expect("abcdefgaaa", 0, 8);
    expect("abcdefgaaaa", 1, 4);
    expect("", 0, 0);
    expect("a", 0, 1);
    expect("ab", 0, 1);
    expect("abcdefgh", 0, 6);
}

// Items of different kinds do not agree, whatever their values.
TEST(test_kinds)
{
    for (int32_t k = 0; k < 8; k++) items[k] = (SeriesItem){.value = 1, .kind = k % 2};
    assert_int_equal(series_regime(items, 8, 1e-2, 0).period, 2);
    for (int32_t k = 0; k < 8; k++) items[k].kind = 0;
    assert_int_equal(series_regime(items, 8, 1e-2, 0).period, 1);
}

// Every item is judged by the last one at its place: a drift ends the regime, even where each step
// of it is small.
TEST(test_drift)
{
    for (int32_t period = 1; period <= 2; period++) {
        for (int32_t k = 0; k < 12; k++)
            items[k].value = (1 + 0.004 * (k / period)) * (k % period ? 1.2 : 1);
        SeriesRegime found = series_regime(items, 12, 0.01, 0);
        assert_int_equal(found.period, period == 1 ? 0 : 2);   // 3 of 12, 6 of 12
    }
    for (int32_t k = 0; k < 9; k++) items[k].value = 1 + 0.004 * k;
    SeriesRegime found = series_regime(items, 9, 0.01, 0);
    assert_true(found.period == 1 && found.count == 3);   // 0.8 % off, 1.2 % is too much
}

// With n equally likely values two items agree with q = 1/n: three in a row with q^2, and of five,
// those at odd and those at even places (but not all of them) with q^3 - q^4.
TEST(test_chance)
{
    const int32_t trials = 40000;
    Random random = {5};
    for (int32_t n = 2; n <= 4; n++) {
        double q = 1.0 / n, once = q * q, twice = q * q * q * (1 - q);
        int32_t found_once = 0, found_twice = 0;
        for (int32_t trial = 0; trial < trials; trial++) {
            for (int32_t k = 0; k < 6; k++) items[k].value = 1 + (int)random_between(&random, 0, n);
            found_once += series_regime(items, 4, 1e-3, 0).period > 0;
            found_twice += series_regime(items, 6, 1e-3, 0).period == 2;
        }
        assert_near("one value", found_once / (double)trials, once, 4 * sqrt(once / trials));
        assert_near("two by turns", found_twice / (double)trials, twice, 4 * sqrt(twice / trials));
    }
}

// States must come back, too, and a period above 1 stands out from what lies between: five items by
// chance of the same kinds, all within the tolerance, are none.
TEST(test_states)
{
    static const double parts[][2] = {{0.6, 0.4}, {0.4, 0.6}, {0.504, 0.496}, {0.5, 0.5}};
    for (int32_t k = 0; k < 8; k++) items[k] = (SeriesItem){.value = 1, .state = parts[k % 2]};
    assert_int_equal(series_regime(items, 8, 0.01, 2).period, 2);
    for (int32_t k = 0; k < 8; k++) items[k].state = parts[2 + k % 2];
    assert_int_equal(series_regime(items, 8, 0.01, 2).period, 1);
    for (int32_t k = 0; k < 8; k++) items[k].kind = k % 2, items[k].state = parts[2 + k / 2 % 2];
    assert_int_equal(series_regime(items, 8, 0.01, 2).period, 0);
}

// --- trend --------------------------------------------------------------------------------------

// By hand; a round of two has the slope of each place.
TEST(test_trend)
{
    set_values((double[]){1, 3, 2, 5, 4, 6}, 6);
    SeriesTrend trend = series_trend(items, 6, 1);
    assert_near("slope", trend.slope, 31.0 / 35, 1e-14);
    assert_near("its error", trend.error, sqrt((17.5 - 31 * 31 / 70.) / 4 / 17.5), 1e-14);
    assert_int_equal(trend.freedoms, 4);
    set_values((double[]){1, 7, 2, 8, 3, 9, 4}, 7);
    trend = series_trend(items, 7, 2);
    assert_near("of each place", trend.slope, 0.5, 1e-14);
    assert_near("none", trend.error, 0, 1e-7);
    // An alternation that grows: both places have a trend, their mean has none.
    set_values((double[]){4.065, 4.171, 4.05, 4.184, 4.037, 4.2, 4.022, 4.214, 4.006}, 9);
    trend = series_trend(items, 9, 2);
    assert_near("of one place", fabs(trend.slope), 0.00725, 1e-4);
    assert_true(series_trend_stands_out(&trend));
    // Without a round: residuals about the slope go along from one to the next, by 0.598, and with
    // what twelve of them leave that too small by 0.908; independent ones have the error 0.0637.
    set_values((double[]){0, 1, 2, 2, 2, 2, 3, 4, 6, 7, 7, 7}, 12);
    trend = series_trend(items, 12, 0);
    assert_near("without a round", trend.slope, 96.5 / 143, 1e-14);
    assert_near("its error", trend.error, 0.2896954975395025, 1e-12);
    assert_int_equal(trend.freedoms, 10);
    set_values((double[]){1, 1, 3, 3, 4, 4}, 6);
    assert_near("fades", series_fading(items, 2), 0.5, 1e-14);
}

// Two feet that slide by turns, more and more unlike, until they slide as one (problem 693 of
// validation/strangers): the scatter grows, and what ends it is no part of what was before.
TEST(test_scatter_grows)
{
    double mu[] = {0.869, 0.714, 0.876, 0.790, 0.767, 0.863, 0.715, 0.653, 0.870, 0.710,
                   0.652, 0.883, 0.686, 0.651, 0.926, 0.653, 0.682, 0.989, 0.612, 1.069,
                   1.132, 1.157, 1.165, 1.164, 1.163, 1.162, 1.162, 1.162};
    const int32_t ends[] = {20, 24, 28};
    for (int32_t k = 0; k < 3; k++) {
        set_values(mu + ends[k] / 4, ends[k] - ends[k] / 4);
        SeriesTrend trend = series_trend(items, ends[k] - ends[k] / 4, 0);
        assert_true(series_trend_stands_out(&trend) && trend.slope > 0);
    }
    // A scatter that fades is none: what lies ahead has the same mean.
    for (int32_t k = 0; k < 20; k++) items[k].value = 1 + (k % 2 ? 0.1 : -0.1) * exp(-k / 5.);
    SeriesTrend fades = series_trend(items, 20, 0);
    assert_false(series_trend_stands_out(&fades));
}

// Where there is none, one in twenty stands out; of the places of a round one by itself in as many
// again, at most.
TEST(test_no_trend)
{
    const int32_t trials = 4000;
    Random random = {13};
    int32_t found[4] = {0};
    for (int32_t trial = 0; trial < trials; trial++) {
        for (int32_t k = 0; k < 36; k++) {
            double sum = 0;
            for (int32_t j = 0; j < 12; j++) sum += random_between(&random, 0, 1);
            items[k].value = sum + (k % 2);
        }
        SeriesTrend trends[] = {series_trend(items, 5, 2), series_trend(items, 9, 2),
                                series_trend(items, 12, 0), series_trend(items, 36, 0)};
        for (int32_t t = 0; t < 4; t++) found[t] += series_trend_stands_out(&trends[t]);
    }
    for (int32_t t = 0; t < 2; t++)
        assert_true(found[t] > 0.05 * trials && found[t] < 0.10 * trials);
    // Without a round fewer do: the correlation that chance shows lengthens errors, and never
    // shortens them.
    for (int32_t t = 2; t < 4; t++)
        assert_true(found[t] > 0.02 * trials && found[t] < 0.05 * trials);
}

// Values that go along with their neighbours (of first order, r = 0.5).
TEST(test_no_trend_of_neighbours)
{
    const int32_t trials = 4000;
    Random random = {17};
    int32_t found[2] = {0};
    for (int32_t trial = 0; trial < trials; trial++) {
        double before = 0;
        for (int32_t k = -20; k < 60; k++) {
            double sum = 0;
            for (int32_t j = 0; j < 12; j++) sum += random_between(&random, -0.5, 0.5);
            before = 0.5 * before + sum;
            if (k >= 0) items[k].value = before;
        }
        SeriesTrend trends[] = {series_trend(items, 15, 0), series_trend(items, 60, 0)};
        for (int32_t t = 0; t < 2; t++) found[t] += series_trend_stands_out(&trends[t]);
    }
    for (int32_t t = 0; t < 2; t++) assert_true(found[t] < 0.16 * trials);
}

// --- mean and decile ----------------------------------------------------------------------------

// 0, 1, ..., 10 in any order: quantiles are linear in between.
TEST(test_arithmetic_series)
{
    set_values((double[]){7, 0, 10, 3, 5, 1, 9, 2, 8, 4, 6}, 11);
    Estimate mean = series_mean(items, 11, 1), decile = series_lowest_decile(items, 11);
    assert_near("mean", mean.value, 5, 1e-14);
    assert_near("decile", decile.value, 1, 1e-14);
    // sqrt(11) over sqrt(11), times half of Student's factor for 11 items; neighbours do not go
    // along, and the blocks of three behind the first two, 6, 4 and 6, say less.
    assert_near("error", mean.error, 2.23 / 2, 1e-14);
    assert_near("between the lowest two", series_lowest_decile(items, 4).value, 0.9, 1e-14);
}

TEST(test_few)
{
    series_sort(NULL, 0);   // a run that failed before its first drop
    set_values((double[]){2, 2, 2, 2, 2}, 5);
    assert_true(isnan(series_mean(items, 0, 1).value));
    assert_true(isnan(series_lowest_decile(items, 0).value));
    Estimate mean = series_mean(items, 1, 1), decile = series_lowest_decile(items, 1);
    assert_true(mean.value == 2 && decile.value == 2 && isnan(mean.error) && isnan(decile.error));
    mean = series_mean(items, 5, 1);
    decile = series_lowest_decile(items, 5);
    assert_true(mean.error == 0 && decile.error == 0);
}

// 1, 2 and 1.2, 2.2: two rounds whose means are 1.5 and 1.7. What differs within a round is no
// error of the mean.
TEST(test_rounds)
{
    set_values((double[]){1, 2, 1.2, 2.2}, 4);
    Estimate mean = series_mean(items, 4, 2);
    assert_near("mean", mean.value, 1.6, 1e-15);
    // 0.1 sqrt(2) over sqrt(2), times half of Student's factor for the two freedoms of four items.
    assert_near("error", mean.error, 0.1 * 4.30 / 2, 1e-15);
}

// 4096 independent draws: mean 1/2, decile 1/10, errors sqrt(1/12/N) and sqrt(0.09/N).
TEST(test_independent)
{
    Random random = {7};
    for (int32_t k = 0; k < LONG; k++) items[k].value = random_between(&random, 0, 1);
    Estimate mean = series_mean(items, LONG, 1), decile = series_lowest_decile(items, LONG);
    double error = sqrt(1. / 12 / LONG), error_decile = sqrt(0.09 / LONG);
    assert_near("mean", mean.value, 0.5, 3 * error);
    assert_near("its error", mean.error / error, 1, 0.3);   // 64 blocks tell it to 9 %
    assert_near("decile", decile.value, 0.1, 3 * error_decile);
    assert_near("its error", decile.error / error_decile, 1, 0.3);
}

// x_k+1 = a x_k + noise, a = 0.8: three times the error that independent items would have; with
// rounds of 4 of them as well.
TEST(test_correlated)
{
    double x = 0;
    Random random = {11};
    for (int32_t k = 0; k < LONG; k++) {
        x = 0.8 * x + random_between(&random, 0, 1) - 0.5;
        items[k].value = x;
    }
    double error = 3 * sqrt(1. / 12 / (1 - 0.64) / LONG);
    for (int32_t round = 1; round <= 4; round += 3) {
        Estimate mean = series_mean(items, LONG, round);
        assert_near("its error", mean.error / error, 1, 0.3);
        assert_near("mean", mean.value, 0, 3 * error);
    }
}

// x_k+1 = a x_k + noise: of bars of twice the error, from so many items, at least this part holds
// the mean 0. By batch means alone, as until 0.2, it was 0.96, 0.86, 0.78, 0.89 and 0.93 of them.
TEST(test_bars_hold)
{
    static const struct {
        double along;
        int32_t count;
        double least;
    } cases[] = {{0, 30, 0.95}, {0.5, 30, 0.91}, {0.5, 8, 0.86}, {0, 4, 0.94}, {0, 8, 0.95}};
    const int32_t trials = 4000;
    Random random = {17};
    for (int32_t c = 0; c < 5; c++) {
        int32_t held = 0;
        double x = 0;
        for (int32_t trial = 0; trial < trials; trial++) {
            for (int32_t k = -20; k < cases[c].count; k++) {
                double noise = -6;
                for (int32_t j = 0; j < 12; j++) noise += random_between(&random, 0, 1);
                x = cases[c].along * x + noise;
                if (k >= 0) items[k].value = x;
            }
            Estimate mean = series_mean(items, cases[c].count, 1);
            held += fabs(mean.value) <= 2 * mean.error;
        }
        if (held < cases[c].least * trials || held > 0.98 * trials)
            fail_msg("of %d items with %g: %g hold", cases[c].count, cases[c].along,
                     held / (double)trials);
    }
}

// --- branches -----------------------------------------------------------------------------------

static void expect_branch(int32_t *from, int32_t kind, int32_t count, double low, double high)
{
    SeriesBranch branch;
    *from = series_branch(items, 7, *from, 0.01, &branch);
    assert_true(branch.kind == kind && branch.count == count);
    assert_near("low", branch.low, low, 0);
    assert_near("high", branch.high, high, 0);
    assert_true(branch.mean >= low - 1e-15 && branch.mean <= high + 1e-15);   // rounded
}

// A branch goes on as long as the next value is near its highest, and holds one kind.
TEST(test_branches)
{
    static const double values[] = {1.018, 3, 1.009, 2, 1, 3.01, 3.02};
    static const int32_t kinds[] = {0, 0, 0, 1, 0, 1, 1};
    for (int32_t k = 0; k < 7; k++) items[k] = (SeriesItem){.value = values[k], .kind = kinds[k]};
    series_sort(items, 7);
    int32_t k = 0;
    expect_branch(&k, 0, 3, 1, 1.018);
    expect_branch(&k, 0, 1, 3, 3);
    expect_branch(&k, 1, 1, 2, 2);
    expect_branch(&k, 1, 2, 3.01, 3.02);
    assert_int_equal(k, 7);
    SeriesBranch every;
    assert_int_equal(series_branch(items, 7, 0, INFINITY, &every), 4);
    assert_near("mean", every.mean, (1 + 1.009 + 1.018 + 3) / 4, 1e-15);
}
