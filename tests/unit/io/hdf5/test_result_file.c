// SPDX-License-Identifier: GPL-2.0-or-later
// Writes a small result and reads it back by the tables. The file is left in
// AMONTONS_TEST_OUTPUT, where tests/end_to_end/test_field_files.py opens it with h5py.
#include "io/hdf5/result_file.h"

#include "base/memory.h"
#include "cases.h"
#include "io/files/own_list.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { NODES = 5, PADS = 3, STEPS = 300 };

static char folder[256];
static const double node_x[NODES] = {0, 0.25, 0.5, 0.75, 1};
static const double node_weight[NODES] = {0.125, 0.25, 0.25, 0.25, 0.125};
static const double node_pad[NODES] = {0, 0, 1, 1, 2};

FIXTURE(make_folder)
{
    const char *given = getenv("AMONTONS_TEST_OUTPUT");
    snprintf(folder, sizeof folder, "%s", given ? given : "/tmp/amontons_result_XXXXXX");
    return (given || mkdtemp(folder)) && own_list_make(folder, &(Error){0}) ? 0 : -1;
}

FIXTURE(remove_folder)
{
    char command[300];
    if (getenv("AMONTONS_TEST_OUTPUT")) return 0;
    snprintf(command, sizeof command, "rm -r %s", folder);
    return system(command);
}

static ResultHead head_of_a_run(void)
{
    ResultHead head = {.title = "Figure 1",
                       .units = "normalised",
                       .version = "0.1.0",
                       .contact_count = NODES,
                       .rod_on_spring = true,
                       .states = 1};
    for (int32_t k = 0; k < RESULT_NUMBERS_COUNT; k++) head.numbers[k] = NAN;
    head.numbers[NUMBER_LENGTH] = 1;
    head.numbers[NUMBER_CRITICAL_VELOCITY] = 3.4e-4;
    head.nodes[NODES_X] = node_x;
    head.nodes[NODES_WEIGHT] = node_weight;
    head.nodes[NODES_PAD] = node_pad;
    return head;
}

// Differs for every series, step and node; small integers, so that every stored type holds it, and
// where one chooses something, one that there is.
static double value_at(int32_t series, int32_t step, int32_t node)
{
    int32_t choices = series == SERIES_STATUS ? 4 : series == SERIES_CERTIFIED ? 2 : 250;
    return (7 * series + 3 * step + node) % choices;
}

static void assert_clean(const Error *err)
{
    if (!error_is_clean(err)) fail_msg("%s", err->message);
}

TEST(a_result_comes_back)
{
    Error err = {0};
    ResultHead head = head_of_a_run();
    ArrayFile *file = result_file_create(folder, &head, &err);
    assert_clean(&err);
    for (int32_t step = 0; step < STEPS; step++)
        for (int32_t s = 0; s < RESULT_SERIES_COUNT; s++) {
            if (!result_series_written(&head, s)) continue;   // in the plane nothing is across
            double row[NODES];
            for (int32_t i = 0; i < NODES; i++) row[i] = value_at(s, step, i);
            assert_true(array_file_append(file, result_series_name(s), row, 1, &err));
        }
    const double peaks[] = {0.001, 0.0025, 0.004};
    assert_true(result_file_write_table(file, PEAKS_U, peaks, 3, &err));
    assert_true(result_file_write_table(file, EVENTS_KIND, NULL, 0, &err));
    assert_true(array_file_set_number(file, result_number_name(NUMBER_MU_M), 0.25, &err));
    assert_true(array_file_close(file, &err));

    file = result_file_open(folder, &err);
    assert_clean(&err);
    double *values = NULL;
    static const int32_t widths[] = {
        [COLUMNS_ONE] = 1, [COLUMNS_NODES] = NODES, [COLUMNS_PADS] = PADS};
    for (int32_t s = 0; s < RESULT_SERIES_COUNT; s++) {
        if (!result_series_written(&head, s)) continue;
        int64_t rows;
        int32_t width;
        assert_true(result_file_read_series(file, s, &values, &rows, &width, &err));
        assert_int_equal(rows, STEPS);
        assert_int_equal(width, widths[result_series_columns(s)]);
        for (int32_t step = 0; step < STEPS; step++)
            for (int32_t i = 0; i < width; i++)
                assert_true(values[step * width + i] == value_at(s, step, i));
        memory_free(values);
    }
    int32_t count = 0;
    assert_true(result_file_read_nodes(file, NODES_PAD, &values, &count, &err));
    assert_int_equal(count, NODES);
    assert_memory_equal(values, node_pad, sizeof node_pad);
    memory_free(values);
    assert_true(result_file_read_table(file, PEAKS_U, &values, &count, &err));
    assert_int_equal(count, 3);
    assert_memory_equal(values, peaks, sizeof peaks);
    memory_free(values);
    assert_true(result_file_read_table(file, EVENTS_KIND, &values, &count, &err));
    assert_int_equal(count, 0);   // written, and empty
    memory_free(values);
    assert_true(result_file_read_table(file, EVENTS_REACH, &values, &count, &err));
    assert_int_equal(count, 0);   // never written
    memory_free(values);
    assert_true(result_file_number(file, NUMBER_CRITICAL_VELOCITY) == 3.4e-4);
    assert_true(result_file_number(file, NUMBER_MU_M) == 0.25);
    assert_true(isnan(result_file_number(file, NUMBER_L_C)));
    double absent;
    assert_false(array_file_get_number(file, result_number_name(NUMBER_L_C), &absent, &err));
    error_clear(&err);
    char title[32];
    assert_true(result_file_text(file, "title", title, sizeof title, &err));
    assert_string_equal(title, "Figure 1");
    assert_true(array_file_close(file, &err));
}

// A file may be anybody's: what would become an index, or is beyond all measure, is refused.
TEST(numbers_have_ranges)
{
    const struct {
        const char *name;
        double value;
    } bad[] = {{"nodes/pad", 2e9},      {"nodes/pad", -1},       {"nodes/pad", NODES},
               {"interface/status", 4}, {"series/certified", 2}, {"series/mu", INFINITY},
               {"series/time", 1e200},  {"nodes/x", -INFINITY},  {"events/kind", 4},
               {"events/kind", -1},     {"events/kind", 0.5},    {"peaks/counts", NAN},
               {"peaks/U", 1e101}};
    char place[280], path[300];
    snprintf(place, sizeof place, "%s/ranges", folder);   // the other file is read by others
    snprintf(path, sizeof path, "%s/history.h5", place);
    assert_int_equal(mkdir(place, 0777), 0);
    for (size_t k = 0; k < sizeof bad / sizeof bad[0]; k++) {
        Error err = {0};
        ResultHead head = head_of_a_run();
        double pads[NODES], x[NODES], *values = NULL, *column[1] = {NULL};
        int64_t rows;
        int32_t width, count;
        memcpy(pads, node_pad, sizeof pads);
        memcpy(x, node_x, sizeof x);
        if (strcmp(bad[k].name, "nodes/pad") == 0) pads[1] = bad[k].value;
        if (strcmp(bad[k].name, "nodes/x") == 0) x[1] = bad[k].value;
        head.nodes[NODES_X] = x;
        ArrayFile *file = result_file_create(place, &head, &err);
        assert_clean(&err);
        assert_true(array_file_cut(file, "nodes/pad", 0, &err));   // the width of series is of it
        assert_true(array_file_append(file, "nodes/pad", pads, NODES, &err));
        for (int32_t s = 0; s < RESULT_SERIES_COUNT; s++) {
            if (!result_series_written(&head, s)) continue;
            double row[NODES] = {0};
            if (strcmp(bad[k].name, result_series_name(s)) == 0) row[0] = bad[k].value;
            assert_true(array_file_append(file, result_series_name(s), row, 1, &err));
        }
        for (int32_t t = 0; t < RESULT_TABLES_COUNT; t++)
            if (strcmp(bad[k].name, result_table_name(t)) == 0)
                assert_true(result_file_write_table(file, t, &bad[k].value, 1, &err));
        assert_true(array_file_close(file, &err));
        file = result_file_open(place, &err);
        assert_clean(&err);
        bool good = true;
        for (int32_t s = 0; good && s < RESULT_SERIES_COUNT; s++)
            if (result_series_written(&head, s)) {
                good = result_file_read_series(file, s, &values, &rows, &width, &err);
                memory_free(values);
            }
        if (good && (good = result_file_read_nodes(file, NODES_X, &values, &count, &err)))
            memory_free(values);
        for (ResultTable t = 0; good && t < RESULT_TABLES_COUNT; t++) {
            good = result_file_read_tables(file, &t, 1, column, &count, &err);
            memory_free(column[0]);
        }
        if (good && (good = result_file_read_nodes(file, NODES_PAD, &values, &count, &err)))
            memory_free(values);
        if (good) fail_msg("%s of %g is taken", bad[k].name, bad[k].value);
        assert_int_equal(err.code, ERROR_FILE);
        assert_non_null(strstr(err.message, bad[k].name));
        err = (Error){0};
        assert_true(array_file_close(file, &err));
    }
    unlink(path);
    assert_int_equal(rmdir(place), 0);
}

TEST(what_is_missing_is_named)
{
    Error err = {0};
    ResultHead head = head_of_a_run();
    assert_null(result_file_open("/proc/none", &err));
    assert_int_equal(err.code, ERROR_INPUT);
    assert_non_null(strstr(err.message, "/proc/none holds no history"));
    error_clear(&err);
    assert_null(result_file_create("/proc/none", &head, &err));
    assert_int_equal(err.code, ERROR_FILE);
    assert_non_null(strstr(err.message, "/proc/none/history.h5"));
    error_clear(&err);
    head.contact_count = 0;
    assert_null(result_file_create(folder, &head, &err));
    assert_non_null(strstr(err.message, "contact nodes"));
}

TEST(every_path_frees_when_memory_is_short)
{
    ResultHead head = head_of_a_run();
    char place[280], path[300];
    snprintf(place, sizeof place, "%s/short", folder);
    snprintf(path, sizeof path, "%s/history.h5", place);
    assert_int_equal(mkdir(place, 0777), 0);
    assert_true(own_list_make(place, &(Error){0}));
    int64_t live = memory_counters().live;
    ErrorCode code = ERROR_MEMORY;
    int32_t k = 0;
    for (; code == ERROR_MEMORY; k++) {
        Error err = {0};
        double *values = NULL;
        int32_t count;
        memory_fail_after(k);
        ArrayFile *file = result_file_create(place, &head, &err);
        if (file) result_file_write_table(file, PEAKS_MU, node_x, 2, &err);
        if (error_is_clean(&err))
            array_file_close(file, &err);
        else
            array_file_abandon(file);
        file = error_is_clean(&err) ? result_file_open(place, &err) : NULL;
        if (file) result_file_read_table(file, PEAKS_U, &values, &count, &err);
        if (file && error_is_clean(&err)) {
            memory_free(values);
            result_file_read_nodes(file, NODES_X, &values, &count, &err);
        }
        memory_fail_after(-1);
        memory_free(values);
        array_file_abandon(file);
        assert_int_equal(memory_counters().live, live);
        code = err.code;
    }
    assert_int_equal(code, ERROR_NONE);
    assert_in_range(k, 40, 70);   // two arrays a series and a few more
    unlink(path);
    snprintf(path, sizeof path, "%s/" OWN_LIST_NAME, place);
    unlink(path);
    assert_int_equal(rmdir(place), 0);
}

GROUP_BETWEEN(make_folder, remove_folder);
