// SPDX-License-Identifier: GPL-2.0-or-later
// Tables of csv_writer are read back; and tables of others, by RFC 4180.
#include "io/text/csv_reader.h"

#include "cases.h"
#include "io/text/csv_writer.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
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
    TextWriter *csv = text_writer_create(PATH, false, &err);
    for (int32_t row = 0; row < 2; ++row) {
        for (int32_t k = 0; k < COUNT; ++k) csv_text(csv, words[k]);
        csv_number(csv, 0.1 + 0.2);
        csv_end_row(csv);
    }
    assert_true(text_writer_finish(csv, &err));
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
    assert_true(isnan(csv_value(&table, 1, 1)));
    assert_true(csv_check(&table, 1, false, &err) && csv_check(&table, -1, true, &err));
    assert_false(csv_check(&table, 1, true, &err));
    assert_string_equal(err.message, "csv_reader_test.csv:2:6: y: `-2` is no number above 0; what "
                                     "is not known is left empty");
    csv_destroy(&table);
}

TEST(wrong_tables_are_told)
{
    static const char *const wrong[] = {"", "a,b\n1\n", "a\n1,2\n", "a,b\n\"1,2\n3,4\n"};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
        Error err = {0};
        CsvTable table;
        assert_false(read_text(wrong[k], &table, &err));
        assert_int_equal(err.code, ERROR_INPUT);
        assert_null(table.cells);
        csv_destroy(&table);
    }
}

// The same numbers as programs write them.
TEST(as_it_is_written)
{
    static const char *const same[] = {
        "U,mu\n0.5,1.25\n2,-3e-2\n",
        "U;mu\n0,5;1,25\n2;-3e-2\n",
        "U\tmu\n0,5\t1,25\n2\t-0,03\n",
        "U\tmu\n0.5\t1.25\n2\t-0.03\n",
        "U mu\n0.5   1.25\n  2 -0.03\n",
        "U mu\n0,5 1,25\n2 -0,03\n",
        "U , mu\n 0.5 , 1.25\n 2 , -0.03 \n",
        "\"U\",\"mu\"\n\"0,5\",\"1,25\"\n\"2\",\"-0,03\"\n",
        "# by hand\n\nU,mu\n# two\n0.5,1.25\n   \n2,-0.03\n\n",
        "# by hand\n# U mu\n0.5 1.25\n2 -0.03\n",
        "# by hand\n# U mu\n0.5, 1.25\n2, -0.03\n",
        "# U, mu\n0.5 1.25\n2 -0.03\n",
        "% U;mu\r\n0,5;1,25;\r\n2;-0,03;\r\n",
        "\xEF\xBB\xBFU,mu\r0.5,1.25\r2,-0.03",
        "sep=;\r\nU;mu\r\n0,5;1,25\r\n2;-0,03\r\n",
    };
    for (size_t k = 0; k < sizeof same / sizeof *same; ++k) {
        Error err = {0};
        CsvTable table;
        if (!read_text(same[k], &table, &err)) fail_msg("%zu: %s", k, err.message);
        assert_true(table.rows == 2 && table.columns == 2);
        assert_int_equal(csv_column(&table, "U"), 0);
        assert_int_equal(csv_column(&table, "mu"), 1);
        const double expected[] = {0.5, 1.25, 2, -0.03};
        for (int32_t c = 0; c < 4; ++c)
            if (csv_value(&table, c / 2, c % 2) != expected[c]) fail_msg("%zu: cell %d", k, c);
        csv_destroy(&table);
    }
}

TEST(numbers_alone)
{
    static const char *const same[] = {"0.5,1.25\n2,3\n", "0.5, 1.25\n2, 3\n", "0,5 1,25\n2 3\n",
                                       "0,5;1,25\n2;3", "# measured\n0.5\t1.25\n2\t3\n"};
    for (size_t k = 0; k < sizeof same / sizeof *same; ++k) {
        Error err = {0};
        CsvTable table;
        assert_false(read_text(same[k], &table, &err));
        assert_non_null(strstr(err.message, "the first row names the columns"));
        error_clear(&err);
        FILE *file = fopen(PATH, "w");
        fputs(same[k], file);
        fclose(file);
        if (!csv_read_bare(PATH, &table, &err)) fail_msg("%zu: %s", k, err.message);
        unlink(PATH);
        assert_false(table.named);
        assert_true(table.rows == 2 && table.columns == 2);
        assert_true(csv_value(&table, 0, 0) == 0.5 && csv_value(&table, 1, 1) == 3);
        csv_destroy(&table);
    }
}

// An error names file, line and place.
TEST(what_is_not_understood_is_told)
{
    static const struct {
        const char *text, *words;
    } wrong[] = {
        {"U,mu,U\n1,2,3\n", "csv_reader_test.csv:1:6: U stands twice, in column 1 and in column 3"},
        {"# a\nU;mu\n0,5;1\n\n0.5;2\n",
         "csv_reader_test.csv:5:1: U: is `0.5`, but line 3 has `0,5`"},
        {"U,mu\n0,5,1,25\n", "csv_reader_test.csv:2: 4 cells, the first row has 2; are these"},
        {"U,mu\n\n1\n", "csv_reader_test.csv:3: 1 cell, the first row has 2"},
    };
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; ++k) {
        Error err = {0};
        CsvTable table;
        assert_false(read_text(wrong[k].text, &table, &err));
        if (!strstr(err.message, wrong[k].words)) fail_msg("%s", err.message);
    }
}

// Texts that keep the reader busy for ever if each place of them is gone over more than a few
// times, as the clock of ctest tells.
TEST(long_rows_are_read_once)
{
    static const struct {
        const char *begin, *again, *end;
    } cases[] = {{"a", " ", "(b c"},         {"a", " ", "(b\n1 2\n"},  {"a", "\t", "b\n1\n"},
                 {"a\n", "\t", "\n"},        {"a\t\"b", "\t", "\"\n"}, {"a", " [", "\n1\n"},
                 {"a", " ", "b,c\n1,2\n"},   {"a", "/", "b,c\n1,2\n"}, {"a", " b", ",c\n1,2\n"},
                 {"a,b", "(", ")\n1,2\n"},   {"", ",", "\n1\n"},       {"", "\"\"", ",c\n1,2\n"},
                 {"# a", " ", "(b\n1 2 3\n"}};
    enum { SIZE = 1 << 21, NAMES = 200000 };
    char *text = malloc(12 * NAMES);
    assert_non_null(text);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Error err = {0};
        CsvTable table;
        CsvUnit unit;
        int32_t length = 0;
        char *at = stpcpy(text, cases[k].begin);
        while (at < text + SIZE) at = stpcpy(at, cases[k].again);
        strcpy(at, cases[k].end);
        if (!read_text(text, &table, &err)) continue;
        for (int32_t column = 0; column < table.columns && column < 3; column++)
            csv_split(&table, column, &length, &unit);
        csv_destroy(&table);
    }

    // Many names, of which the last one stands twice, or none.
    for (int32_t turn = 0; turn < 2; turn++) {
        Error err = {0};
        CsvTable table;
        char *at = text;
        for (int32_t k = 0; k < NAMES; k++) at += sprintf(at, "n%d,", (int)k);
        strcpy(at, turn == 0 ? "n70000\n" : "last\n");
        assert_int_equal(read_text(text, &table, &err), turn == 1);
        if (turn == 1)
            assert_int_equal(table.columns, NAMES + 1);
        else
            assert_non_null(strstr(err.message, "n70000 stands twice, in column 70001 and in "
                                                "column 200001"));
        csv_destroy(&table);
    }
    free(text);
}

TEST(units_behind_names)
{
    static const struct {
        const char *name, *asked, *unit;   // unit NULL: another name
    } heads[] = {
        {"U", "U", ""},
        {"U (mm)", "U", "mm"},
        {"F_T [kN]", "F_T", "kN"},
        {"t/s", "t", "s"},
        {"t in s", "t", "s"},
        {"U mm", "U", "mm"},
        {"x_mm", "x", "mm"},
        {"v/(m/s)", "v", "m/s"},
        {"v (m/s)", "v", "m/s"},
        {"v mm/s", "v", "mm/s"},
        {"U (parsec)", "U", "parsec"},
        {"F_T/F_N", "F_T", NULL},
        {"U/L", "U", NULL},
        {"x_error", "x", NULL},
        {"F_N", "F", "N"},
        {"load", "l", NULL},
        {"t[ min ]", "t", "min"},
        {"mu (-)", "mu", "-"},
        {"mu [1]", "mu", "1"},
        {"mu/1", "mu", "1"},
        {"slip (%)", "slip", "%"},
        {"x_1", "x", NULL},
        {"x 1", "x", NULL},
        {"f (Hz)", "f", "Hz"},
        {"w rad/s", "w", "rad/s"},
        {"t/h", "t", "h"},
        {"Time (s)", "t", "s"},
        {"Friction Force [kN]", "F_T", "kN"},
        {"friction_coefficient", "mu", ""},
        {"\xCE\xBC [-]", "mu", "-"},
        {"T (s)", "t", NULL},
        {"storage_Modulus in MPa", "storage modulus", "MPa"},
        {"E(t) (MPa)", "E", NULL},
        {"E(t) (MPa)", "E(t)", "MPa"},
        {"E\xE2\x80\xB2 (N/mm\xC2\xB2)", "E'", "N/mm\xC2\xB2"},
        {"E\xE2\x80\xB3/MPa", "E''", "MPa"},
        {"E\" (MPa)", "E''", "MPa"},
        {"E'' (MPa)", "E'", NULL},
    };
    for (size_t k = 0; k < sizeof heads / sizeof *heads; ++k) {
        char text[80];
        Error err = {0};
        CsvTable table;
        CsvUnit unit;
        int32_t column = -1;
        snprintf(text, sizeof text, "a;%s\n1;2\n", heads[k].name);
        assert_true(read_text(text, &table, &err));
        assert_true(csv_find(&table, heads[k].asked, &column, &unit, &err));
        if ((column == 1) != (heads[k].unit != NULL)) fail_msg("%s", heads[k].name);
        if (column == 1 && (unit.length != (int32_t)strlen(heads[k].unit) ||
                            strncmp(unit.text, heads[k].unit, (size_t)unit.length) != 0))
            fail_msg("%s: %.*s", heads[k].name, unit.length, unit.text);
        csv_destroy(&table);
    }
}

TEST(columns_of_errors)
{
    static const struct {
        const char *head;
        int32_t of, error;   // error -1: none
        const char *unit;
    } heads[] = {{"U (mm);mu;mu_error", 1, 2, ""},
                 {"U (mm);mu;mu_error", 0, -1, ""},
                 {"U (mm);U error (um);mu", 0, 1, "um"},
                 {"sigma_mu;mu;x", 1, 0, ""},
                 {"mu;std;x", 0, 1, ""},
                 {"mu (-);+- (%);x", 0, 1, "%"},
                 {"x;mu;\xC2\xB1", 1, 2, ""},
                 {"error;x;mu", 2, -1, ""},
                 {"mu_mean;x;mu_std", 0, 2, ""},
                 {"Friction coefficient;friction coefficient error;x", 0, 1, ""},
                 {"x;l/L;l/L_error", 1, 2, ""},
                 {"x;l/L;l_error", 1, -1, ""},
                 {"mu;stdev;x", 0, -1, ""}};
    for (size_t k = 0; k < sizeof heads / sizeof *heads; ++k) {
        char text[80];
        Error err = {0};
        CsvTable table = {0};
        CsvUnit unit;
        int32_t column = 0;
        snprintf(text, sizeof text, "%s\n1;2;3\n", heads[k].head);
        if (!read_text(text, &table, &err)) fail_msg("%s", err.message);
        csv_find_error(&table, heads[k].of, &column, &unit);
        if (column != heads[k].error) fail_msg("%s: %d", heads[k].head, column);
        assert_int_equal(unit.length, strlen(heads[k].unit));
        assert_memory_equal(unit.text, heads[k].unit, strlen(heads[k].unit));
        csv_destroy(&table);
    }
}

// A dash stands where a quantity has no unit; a row of ones is one of values.
TEST(units_in_a_row)
{
    Error err = {0};
    CsvTable table = {0};
    CsvUnit unit;
    assert_true(read_text("v;mu\nmm/s;-\n1;0,3\n", &table, &err));
    assert_int_equal(table.rows, 1);
    int32_t length = 0;
    csv_split(&table, 0, &length, &unit);
    assert_true(length == 1 && unit.length == 4 && strncmp(unit.text, "mm/s", 4) == 0);
    csv_destroy(&table);
    assert_true(read_text("v,mu\n1,1\n2,1\n", &table, &err));
    assert_int_equal(table.rows, 2);
    csv_destroy(&table);
}

TEST(one_quantity_stands_once)
{
    Error err = {0};
    CsvTable table;
    CsvUnit unit;
    int32_t column = -1, length = 0;
    double factor = 0;
    assert_true(read_text("U (mm),U/um,load.pressure (kPa)\n1,2,3\n", &table, &err));
    assert_false(csv_find(&table, "U", &column, &unit, &err));
    assert_string_equal(err.message, "csv_reader_test.csv:1:8: U/um is U a second time, beside "
                                     "column 1, U (mm)");
    error_clear(&err);
    csv_split(&table, 2, &length, &unit);
    assert_int_equal(length, strlen("load.pressure"));
    assert_true(csv_to_si(&table, 2, unit, "stress", &factor, &err));
    assert_true(factor == 1000);
    assert_false(csv_to_si(&table, 2, unit, "length", &factor, &err));
    assert_string_equal(err.message,
                        "csv_reader_test.csv:1:13: load.pressure (kPa) has `kPa`, which "
                        "is no unit of length; allowed: m, mm, um");
    csv_destroy(&table);
}
