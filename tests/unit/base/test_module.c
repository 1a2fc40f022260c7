// SPDX-License-Identifier: GPL-2.0-or-later
// Opening modules: the ones that were built, and what is said when one cannot be had. And the
// clock, which only has to go forward at the right pace.
#include "base/module.h"

#include "base/clock.h"
#include "near.h"

#include <time.h>

TEST(test_missing_module)
{
    Error err = {0};
    assert_null(module_function("no_such_part", "anything", &err));
    assert_int_equal(err.code, ERROR_LIBRARY);
    assert_non_null(strstr(err.message, "amontons_no_such_part.so"));
    assert_non_null(strstr(err.message, getenv("AMONTONS_MODULES")));
}

TEST(test_missing_symbol)
{
    Error err = {0};
    assert_null(module_function("gmsh", "no_such_function", &err));
    assert_int_equal(err.code, ERROR_LIBRARY);
    assert_non_null(strstr(err.message, "amontons_gmsh.so"));
    assert_non_null(strstr(err.message, "no_such_function"));
}

TEST(test_found_twice_is_the_same)
{
    Error err = {0};
    ModuleFunction first = module_function("gmsh", "amontons_gmsh_read", &err);
    ModuleFunction again = module_function("gmsh", "amontons_gmsh_read", &err);
    assert_true(error_is_clean(&err));
    assert_true(first != NULL && first == again);
}

// Without AMONTONS_MODULES the program looks beside itself, where a test program has none.
TEST(test_beside_the_program)
{
    Error err = {0};
    char given[4096];
    snprintf(given, sizeof given, "%s", getenv("AMONTONS_MODULES"));
    unsetenv("AMONTONS_MODULES");
    assert_null(module_function("no_such_part", "anything", &err));
    assert_non_null(strstr(err.message, "tests/amontons_no_such_part.so"));
    setenv("AMONTONS_MODULES", given, 1);
}

TEST(test_clock)
{
    double before = clock_seconds();
    struct timespec pause = {.tv_nsec = 20000000};
    nanosleep(&pause, NULL);
    double passed = clock_seconds() - before;
    assert_true(passed >= 0.02 && passed < 2);
}
