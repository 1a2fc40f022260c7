// SPDX-License-Identifier: GPL-2.0-or-later
// Series of letters: two items agree when their letters do. What repeats is counted by eye.
#include "record/repetition.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <string.h>

#include <cmocka.h>

static bool same_letter(const void *series, int32_t k, int32_t later)
{
    const char *letters = series;
    return letters[k] == letters[later];
}

static int32_t count(const char *letters, int32_t period)
{
    return repetition_count((int32_t)strlen(letters), period, same_letter, letters);
}

static void test_periods(void **state)
{
    (void)state;
    assert_int_equal(count("xaaaa", 1), 4);
    assert_int_equal(count("aaaaa", 1), 4);   // the run's first item is left out in any case
    assert_int_equal(count("xabaaa", 1), 3);
    assert_int_equal(count("xbabab", 1), 1);   // no two in a row agree: one alone
    assert_int_equal(count("xbabab", 2), 5);
    assert_int_equal(count("xccabab", 2), 4);
    assert_int_equal(count("xabcabcab", 3), 8);
    assert_int_equal(count("xabcabcab", 2), 2);
}

// Up to one period there is nothing that could disagree.
static void test_short_series(void **state)
{
    (void)state;
    assert_int_equal(count("a", 1), 1);
    assert_int_equal(count("xa", 1), 1);
    assert_int_equal(count("xa", 2), 2);
}

// Each item is judged by the last of its phase, not by its neighbour: a drift ends the count, even
// where every step of it is small.
static bool near_letter(const void *series, int32_t k, int32_t later)
{
    const char *letters = series;
    return letters[later] - letters[k] <= 1 && letters[k] - letters[later] <= 1;
}

static void test_drift(void **state)
{
    (void)state;
    assert_int_equal(repetition_count(7, 1, near_letter, "xabcdef"), 2);
    assert_int_equal(repetition_count(7, 1, near_letter, "xfefefe"), 6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_periods),
                                       cmocka_unit_test(test_short_series),
                                       cmocka_unit_test(test_drift)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
