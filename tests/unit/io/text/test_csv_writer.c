// SPDX-License-Identifier: GPL-2.0-or-later
// Cells as RFC 4180 wants them, numbers that read back as the same doubles, no file on failure.
#include "io/text/csv_writer.h"

#include "base/memory.h"
#include "cases.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static char path[] = "/tmp/amontons_csv_XXXXXX";

static void read_back(char *text, size_t size)
{
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    text[fread(text, 1, size - 1, file)] = 0;
    fclose(file);
}

TEST(cells_are_quoted_where_they_must_be)
{
    Error err = {0};
    char text[400];
    unlink(path);
    TextWriter *csv = text_writer_create(path, false, &err);
    assert_non_null(csv);
    csv_text(csv, "plain");
    csv_text(csv, "a,b");
    csv_text(csv, "say \"no\"");
    csv_end_row(csv);
    csv_text(csv, "");
    csv_number(csv, NAN);
    csv_number(csv, 0.1);
    csv_text(csv, "two\nlines");
    csv_end_row(csv);
    assert_true(text_writer_finish(csv, &err));
    read_back(text, sizeof text);
    assert_string_equal(text, "plain,\"a,b\",\"say \"\"no\"\"\"\n,,0.1,\"two\nlines\"\n");
}

TEST(numbers_keep_their_bits)
{
    static const double values[] = {1.0 / 3, 1e-300, 123456789.0, -0.38, 5e-324, 4};
    Error err = {0};
    char text[400], *at = text;
    unlink(path);
    TextWriter *csv = text_writer_create(path, false, &err);
    for (int32_t k = 0; k < 6; k++) csv_number(csv, values[k]);
    csv_end_row(csv);
    assert_true(text_writer_finish(csv, &err));
    read_back(text, sizeof text);
    for (int32_t k = 0; k < 6; k++, at++) assert_true(strtod(at, &at) == values[k]);
    assert_string_equal(at, "");
}

// To half of the ninth digit, whatever their size, and in a form that spreadsheets read.
TEST(rounded_numbers_have_nine_digits)
{
    static const double values[] = {
        0,     1,      -0.38,        1.0 / 3,     0.00012345678912, 1e-5,
        1e300, -1e-80, 123456789.49, 9999999999., 0.99999999999,    1e-300};
    enum { COUNT = sizeof values / sizeof *values };
    Error err = {0};
    char text[400], *at = text;
    unlink(path);
    TextWriter *csv = text_writer_create(path, false, &err);
    for (int32_t k = 0; k < COUNT; k++) csv_rounded(csv, values[k]);
    csv_rounded(csv, NAN);
    csv_end_row(csv);
    assert_true(text_writer_finish(csv, &err));
    read_back(text, sizeof text);
    assert_null(strstr(text, "inf"));
    assert_int_equal(strncmp(text, "0,1,-0.38,0.333333333,", 22), 0);
    for (int32_t k = 0; k < COUNT; k++, at++) {
        assert_true(fabs(strtod(at, &at) - values[k]) <= 5.01e-9 * fabs(values[k]));
        assert_int_equal(*at, ',');
    }
}

// Far more than is kept back before it is written.
TEST(long_files_are_whole)
{
    Error err = {0};
    enum { ROWS = 30000 };
    static char text[20 * ROWS];
    unlink(path);
    TextWriter *csv = text_writer_create(path, false, &err);
    for (int32_t k = 0; k < ROWS; k++) {
        csv_number(csv, k);
        csv_text(csv, "a cell");
        csv_end_row(csv);
    }
    assert_true(text_writer_finish(csv, &err));
    read_back(text, sizeof text);
    const char *at = text;
    for (int32_t k = 0; k < ROWS; k++) {
        char row[30];
        int length = snprintf(row, sizeof row, "%d,a cell\n", k);
        if (strncmp(at, row, (size_t)length) != 0) fail_msg("row %d is `%.20s`", k, at);
        at += length;
    }
    assert_string_equal(at, "");
}

TEST(nothing_is_left_after_an_error)
{
    Error err = {0};
    unlink(path);
    int64_t live = memory_counters().live;
    unlink(path);
    TextWriter *csv = text_writer_create(path, false, &err);
    csv_text(csv, "half");
    error_set(&err, ERROR_INPUT, __FILE__, __LINE__, "no second half");
    assert_false(text_writer_finish(csv, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    assert_false(text_writer_finish(NULL, &err));
    err = (Error){0};
    assert_int_not_equal(access(path, F_OK), 0);
    assert_null(text_writer_create("/proc/none/at/all.csv", false, &err));
    assert_int_equal(err.code, ERROR_FILE);
    assert_int_equal(memory_counters().live, live);
}

FIXTURE(group_begin)
{
    return close(mkstemp(path));
}

FIXTURE(group_end)
{
    return unlink(path);
}

GROUP_BETWEEN(group_begin, group_end);
