// SPDX-License-Identifier: GPL-2.0-or-later
// What csv_writer writes comes back; and tables of others, by RFC 4180.
#include "io/text/csv_reader.h"

#include "cases.h"
#include "io/text/csv_writer.h"

#include <math.h>
#include <stdio.h>
#include <unistd.h>

static const char PATH[] = "csv_reader_test.csv";

static bool read_text(const char *text, CsvTable *table, Error *err)
{
    FILE *file = fopen(PATH, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
    bool done = csv_read(PATH, table, err);
    unlink(PATH);
    return done;
}

TEST(what_was_written_is_read)
{
    static const char *const words[] = {"a", "b,c", "say \"x\"", "two\nlines", "", "\""};
    enum { COUNT = sizeof words / sizeof *words };
    Error err = {0};
    CsvTable table;
    CsvWriter *csv = csv_create(PATH, &err);
    for (int32_t row = 0; row < 2; ++row) {
        for (int32_t k = 0; k < COUNT; ++k) csv_text(csv, words[k]);
        csv_number(csv, 0.1 + 0.2);
        csv_end_row(csv);
    }
    assert_true(csv_finish(csv, &err));
    assert_true(csv_read(PATH, &table, &err));
    unlink(PATH);
    assert_int_equal(table.rows, 1);
    assert_int_equal(table.columns, COUNT + 1);
    for (int32_t k = 0; k < COUNT; ++k) {
        assert_string_equal(csv_name(&table, k), words[k]);
        assert_string_equal(csv_cell(&table, 0, k), words[k]);
        assert_int_equal(csv_column(&table, words[k]), k);
        assert_true(isnan(csv_value(&table, 0, k)));
    }
    assert_true(csv_value(&table, 0, COUNT) == 0.1 + 0.2);
    assert_int_equal(csv_column(&table, "no such"), -1);
    assert_string_equal(csv_cell(&table, 0, -1), "");
    csv_destroy(&table);
}

TEST(other_line_ends_are_read)
{
    Error err = {0};
    CsvTable table;
    assert_true(read_text("x,y\r\n1,\"2\"\r\n3,4", &table, &err));
    assert_int_equal(table.rows, 2);
    assert_true(csv_value(&table, 0, 1) == 2);
    assert_true(csv_value(&table, 1, 1) == 4);
    csv_destroy(&table);
    assert_true(read_text("x,y\r1,2x\r", &table, &err));
    assert_int_equal(table.rows, 1);
    assert_true(csv_value(&table, 0, 0) == 1);
    assert_true(isnan(csv_value(&table, 0, 1)));   // no number, though it begins with one
    csv_destroy(&table);
    assert_true(read_text("x,y\n 1 , -2\n1, \n", &table, &err));
    assert_true(csv_value(&table, 0, 0) == 1 && csv_value(&table, 0, 1) == -2);
    assert_true(csv_check(&table, 1, false, &err) && csv_check(&table, -1, true, &err));
    assert_false(csv_check(&table, 1, true, &err));
    assert_string_equal(err.message,
                        "line 2, y: ` -2` is no number above 0; what is not known is left empty");
    csv_destroy(&table);
}

TEST(wrong_tables_are_told)
{
    static const char *const wrong[] = {"", "a,b\n1\n", "a\n1,2\n", "a,b\n1,", "a,b\n\"1,2\n3,4\n"};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
        Error err = {0};
        CsvTable table;
        assert_false(read_text(wrong[k], &table, &err));
        assert_int_equal(err.code, ERROR_INPUT);
        assert_null(table.cells);
        csv_destroy(&table);
    }
}
