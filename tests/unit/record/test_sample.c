// SPDX-License-Identifier: GPL-2.0-or-later
// Series whose mean, decile and errors are known: an arithmetic ladder, a constant, and an
// autoregressive one of first order, whose mean has sqrt((1 + a) / (1 - a)) times the error of
// independent items.
#include "record/sample.h"

#include "near.h"
#include "random_numbers.h"

#include <math.h>
#include <stdint.h>

enum { LONG = 4096 };

static double at(const void *series, int32_t k)
{
    return ((const double *)series)[k];
}

// 0, 1, ..., 10 in any order, after one that is not asked for: quantiles are linear in between.
static void test_ladder(void **state)
{
    (void)state;
    const double series[] = {99, 7, 0, 10, 3, 5, 1, 9, 2, 8, 4, 6};
    SampleSummary found = sample_summarise(series, at, 1, 11);
    assert_near("mean", found.mean, 5, 1e-14);
    assert_near("decile", found.decile, 1, 1e-14);
    // sqrt(11) over sqrt(11); the blocks of three behind the first two, 6, 4 and 6, say less.
    assert_near("error", found.mean_error, 1, 1e-14);
    SampleSummary four = sample_summarise(series, at, 1, 4);
    assert_near("between the lowest two", four.decile, 0.9, 1e-14);
}

static void test_few(void **state)
{
    (void)state;
    const double series[] = {2, 2, 2, 2, 2};
    SampleSummary none = sample_summarise(series, at, 0, 0),
                  one = sample_summarise(series, at, 0, 1);
    assert_true(isnan(none.mean) && isnan(none.decile) && isnan(none.decile_error));
    assert_true(one.mean == 2 && one.decile == 2 && isnan(one.mean_error));
    SampleSummary same = sample_summarise(series, at, 0, 5);
    assert_true(same.mean_error == 0 && same.decile_error == 0);
}

// Items of 4096 independent draws: mean 1/2, decile 1/10, errors sqrt(1/12/N) and sqrt(0.09/N).
static void test_independent(void **state)
{
    (void)state;
    double series[LONG];
    Random random = {7};
    for (int32_t k = 0; k < LONG; k++) series[k] = random_between(&random, 0, 1);
    SampleSummary found = sample_summarise(series, at, 0, LONG);
    double error = sqrt(1. / 12 / LONG), decile = sqrt(0.09 / LONG);
    assert_near("mean", found.mean, 0.5, 3 * error);
    assert_near("its error", found.mean_error / error, 1, 0.3);   // 64 blocks tell it to 9 %
    assert_near("decile", found.decile, 0.1, 3 * decile);
    assert_near("its error", found.decile_error / decile, 1, 0.3);
}

// x_k+1 = a x_k + noise, a = 0.8: three times the error that independent items would have.
static void test_correlated(void **state)
{
    (void)state;
    double series[LONG], x = 0;
    Random random = {11};
    for (int32_t k = 0; k < LONG; k++) {
        x = 0.8 * x + random_between(&random, 0, 1) - 0.5;
        series[k] = x;
    }
    SampleSummary found = sample_summarise(series, at, 0, LONG);
    double error = 3 * sqrt(1. / 12 / (1 - 0.64) / LONG);
    assert_near("its error", found.mean_error / error, 1, 0.3);
    assert_near("mean", found.mean, 0, 3 * error);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_ladder),
        cmocka_unit_test(test_few),
        cmocka_unit_test(test_independent),
        cmocka_unit_test(test_correlated),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
