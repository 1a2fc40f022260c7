// SPDX-License-Identifier: GPL-2.0-or-later
// The convention that base/error.h states.
#include "base/error.h"

#include "near.h"

static bool first_cause(bool fails, int *reached, Error *err)
{
    if (fails) FAIL(err, ERROR_INPUT, "no such group: '%s' of %d", "tpo", 4);
    *reached += 1;
cleanup:
    *reached += 10;
    return error_is_clean(err);
}

static bool passes_on(bool fails, int *reached, Error *err)
{
    TRY(first_cause(fails, reached, err));
    *reached += 100;
cleanup:
    return error_is_clean(err);
}

TEST(test_fail_and_try)
{
    Error err = {0};
    int reached = 0;
    assert_true(passes_on(false, &reached, &err));
    assert_int_equal(reached, 111);
    assert_true(error_is_clean(&err));
    reached = 0;
    assert_false(passes_on(true, &reached, &err));
    assert_int_equal(reached, 10);   // cleanup runs, nothing after the fault does
    assert_int_equal(err.code, ERROR_INPUT);
    assert_string_equal(err.message, "no such group: 'tpo' of 4");
    assert_non_null(strstr(err.file, "test_error.c"));
    assert_true(err.line > 5 && err.line < 20);
}

TEST(test_first_cause_is_kept)
{
    Error err = {0};
    error_set(&err, ERROR_MEMORY, "a.c", 7, "first");
    error_set(&err, ERROR_FILE, "b.c", 8, "second");
    assert_int_equal(err.code, ERROR_MEMORY);
    assert_string_equal(err.message, "first");
    assert_string_equal(err.file, "a.c");
    assert_int_equal(err.line, 7);
    error_clear(&err);
    assert_true(error_is_clean(&err));
    assert_string_equal(err.message, "");
    error_set(&err, ERROR_FILE, "b.c", 8, "second");
    assert_int_equal(err.code, ERROR_FILE);
}

TEST(test_context)
{
    Error err = {0};
    error_context(&err, "while nothing is wrong");
    assert_true(error_is_clean(&err));
    assert_string_equal(err.message, "");
    error_set(&err, ERROR_FILE, "a.c", 1, "no space");
    error_context(&err, "writing %s", "run.json");
    error_context(&err, "at the end");
    assert_string_equal(err.message, "at the end: writing run.json: no space");
    assert_int_equal(err.code, ERROR_FILE);
}

// Messages longer than there is room for are cut, and never written past.
TEST(test_long_messages)
{
    char text[2 * ERROR_MESSAGE_SIZE];
    memset(text, 'x', sizeof text);
    text[sizeof text - 1] = 0;
    struct {
        Error err;
        char guard[64];
    } held = {0};
    error_set(&held.err, ERROR_INPUT, "a.c", 1, "%s", text);
    assert_int_equal(strlen(held.err.message), ERROR_MESSAGE_SIZE - 1);
    error_context(&held.err, "while reading");
    assert_int_equal(strlen(held.err.message), ERROR_MESSAGE_SIZE - 1);
    assert_memory_equal(held.err.message, "while reading: xxx", 18);
    error_context(&held.err, "%s", text);   // a context that leaves no room keeps the cause
    assert_int_equal(strlen(held.err.message), ERROR_MESSAGE_SIZE - 1);
    assert_non_null(strstr(held.err.message, "while reading: xxx"));
    for (size_t k = 0; k < sizeof held.guard; k++) assert_int_equal(held.guard[k], 0);
}

TEST(test_exit_statuses)
{
    assert_int_equal(amontons_error_exit_status(ERROR_NONE), 0);
    assert_int_equal(amontons_error_exit_status(ERROR_INPUT), 2);
    const ErrorCode failed[] = {ERROR_FILE, ERROR_MEMORY, ERROR_LIBRARY, ERROR_COMPUTE,
                                ERROR_INTERRUPT};
    for (size_t k = 0; k < sizeof failed / sizeof failed[0]; k++) {
        assert_int_equal(amontons_error_exit_status(failed[k]), 1);
        assert_true(strlen(amontons_error_name(failed[k])) > 0);
    }
    assert_int_equal(amontons_error_exit_status((ErrorCode)99), 1);
    assert_string_equal(amontons_error_name((ErrorCode)99), "unknown");
    assert_string_equal(amontons_error_name(ERROR_INPUT), "wrong input");
}
