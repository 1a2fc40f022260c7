// SPDX-License-Identifier: GPL-2.0-or-later
// Opening modules: the ones that were built, and what is said when one cannot be had. And the
// clock, which only has to go forward at the right pace.
#include "base/module.h"

#include "base/clock.h"
#include "near.h"

#include <time.h>

static void test_missing_module(void **state)
{
    (void)state;
    Error err = {0};
    assert_null(module_function("no_such_part", "anything", &err));
    assert_int_equal(err.code, ERROR_LIBRARY);
    assert_non_null(strstr(err.message, "amontons_no_such_part.so"));
    assert_non_null(strstr(err.message, getenv("AMONTONS_MODULES")));
}

static void test_missing_symbol(void **state)
{
    (void)state;
    Error err = {0};
    assert_null(module_function("gmsh", "no_such_function", &err));
    assert_int_equal(err.code, ERROR_LIBRARY);
    assert_non_null(strstr(err.message, "amontons_gmsh.so"));
    assert_non_null(strstr(err.message, "no_such_function"));
}

static void test_found_twice_is_the_same(void **state)
{
    (void)state;
    Error err = {0};
    ModuleFunction first = module_function("gmsh", "amontons_gmsh_read", &err);
    ModuleFunction again = module_function("gmsh", "amontons_gmsh_read", &err);
    assert_true(error_is_clean(&err));
    assert_true(first != NULL && first == again);
}

// Without AMONTONS_MODULES the program looks beside itself, where a test program has none.
static void test_beside_the_program(void **state)
{
    (void)state;
    Error err = {0};
    char given[4096];
    snprintf(given, sizeof given, "%s", getenv("AMONTONS_MODULES"));
    unsetenv("AMONTONS_MODULES");
    assert_null(module_function("no_such_part", "anything", &err));
    assert_non_null(strstr(err.message, "/tests/amontons_no_such_part.so"));
    setenv("AMONTONS_MODULES", given, 1);
}

static void test_clock(void **state)
{
    (void)state;
    double before = clock_seconds();
    struct timespec pause = {.tv_nsec = 20000000};
    nanosleep(&pause, NULL);
    double passed = clock_seconds() - before;
    assert_true(passed >= 0.02 && passed < 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_missing_module),
        cmocka_unit_test(test_missing_symbol),
        cmocka_unit_test(test_found_twice_is_the_same),
        cmocka_unit_test(test_beside_the_program),
        cmocka_unit_test(test_clock),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
