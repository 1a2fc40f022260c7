// SPDX-License-Identifier: GPL-2.0-or-later
// cmocka with the headers that it wants before its own, and tests that register themselves:
//     TEST(test_sum) { assert_int_equal(1 + 1, 2); }
// is all that there is to write. main() is in cases.c; CMOCKA_TEST_FILTER picks some by name.
#ifndef AMONTONS_TESTS_CASES_H
#define AMONTONS_TESTS_CASES_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

void add_case(const struct CMUnitTest *test);
void set_group(CMFixtureFunction before, CMFixtureFunction after);

// `before` and `after` run for this test alone (NULL: nothing does).
#define TEST_BETWEEN(name, before, after)                                                          \
    static void name(void **state);                                                                \
    __attribute__((constructor)) static void add_##name(void)                                      \
    {                                                                                              \
        add_case(&(struct CMUnitTest){#name, name, before, after, NULL});                          \
    }                                                                                              \
    static void name(__attribute__((unused)) void **state)

#define TEST(name) TEST_BETWEEN(name, NULL, NULL)

// A function that runs before or after: FIXTURE(begin) { ...; return 0; }
#define FIXTURE(name) static int name(__attribute__((unused)) void **state)

// Once a file: `before` runs ahead of its first test, `after` behind its last.
#define GROUP_BETWEEN(before, after)                                                               \
    __attribute__((constructor)) static void add_group(void)                                       \
    {                                                                                              \
        set_group(before, after);                                                                  \
    }                                                                                              \
    static void add_group(void)

#endif
