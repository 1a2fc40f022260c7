// SPDX-License-Identifier: GPL-2.0-or-later
// Every figure of a small result, with memory running out at every place it is asked for.
#include "render/render.h"

#include "base/memory.h"
#include "cases.h"
#include "io/files/own_list.h"
#include "io/hdf5/result_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { NODES = 5, STEPS = 200, PATH_SIZE = 400, FAULTS_MAX = 2000 };

static char folder[PATH_SIZE];

// Slip spreads from x = 0 with U; mu falls at U = 1.
static bool steps_write(ArrayFile *file, const ResultHead *head, Error *err)
{
    for (int32_t k = 0; k < STEPS; ++k) {
        double row[NODES], U = k / 100.0;
        for (int32_t s = 0; s < RESULT_SERIES_COUNT; ++s) {
            if (!result_series_written(head, (ResultSeries)s)) continue;
            bool of_nodes = result_series_columns((ResultSeries)s) == COLUMNS_NODES;
            int32_t width = of_nodes ? NODES : 2;   // pads
            for (int32_t i = 0; i < width; ++i) row[i] = i < U * NODES ? 0.01 : 0;
            if (s == SERIES_ROD || s == SERIES_TIME) row[0] = U;
            if (s == SERIES_MU) row[0] = 0.1 + 0.2 * (U < 1 ? U : U - 1);
            if (s == SERIES_STATUS) row[0] = k % 2;
            TRY(array_file_append(file, result_series_name((ResultSeries)s), row, 1, err));
        }
    }
cleanup:
    return error_is_clean(err);
}

FIXTURE(result_write)
{
    static const double x[NODES] = {0, 0.25, 0.5, 0.75, 1}, pad[NODES] = {0, 0, 1, 1, 1},
                        line[NODES] = {1, 1, 1, 1, 1};
    const double kind[2] = {1, 2}, counts[2] = {0, 1}, U_start[2] = {0.9, 1},
                 U_stop[2] = {0.91, 1.01};
    ResultHead head = {.title = "t",
                       .units = "si",
                       .version = "0",
                       .rod_on_spring = true,
                       .states = 1,
                       .contact_count = NODES};
    Error err = {0};
    for (int32_t k = 0; k < RESULT_NODES_COUNT; ++k)
        head.nodes[k] = k == NODES_PAD ? pad : k == NODES_LINE ? line : x;
    for (int32_t k = 0; k < RESULT_NUMBERS_COUNT; ++k) head.numbers[k] = 0.01 * (k + 1);
    snprintf(folder, sizeof folder, "/tmp/amontons_render_XXXXXX");
    if (!mkdtemp(folder) || !own_list_make(folder, &err)) return -1;
    ArrayFile *file = result_file_create(folder, &head, &err);
    bool done = file && steps_write(file, &head, &err);
    for (int32_t table = 0; done && table < RESULT_TABLES_COUNT; ++table) {
        const double *values = table == EVENTS_KIND      ? kind
                               : table == PEAKS_COUNTS   ? counts
                               : table == EVENTS_U_START ? U_start
                                                         : U_stop;
        done = result_file_write_table(file, (ResultTable)table, values, 2, &err);
    }
    return array_file_close(file, &err) && done ? 0 : -1;
}

FIXTURE(result_remove)
{
    char command[PATH_SIZE + 20];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return system(command);
}

static bool picture_exists(const char *name)
{
    char path[PATH_SIZE + 50];
    snprintf(path, sizeof path, "%s/figures/%s", folder, name);
    return access(path, F_OK) == 0;
}

TEST(draws_all_and_frees_all)
{
    Error err = {0};
    PictureRequest request = {0};
    int64_t live = memory_counters().live;
    assert_true(amontons_render(folder, &request, &err));
    assert_int_equal(memory_counters().live, live);
    assert_true(picture_exists("force.png"));
    assert_true(picture_exists("slip-map.png"));
    assert_true(picture_exists("contact-density.png"));
    assert_true(picture_exists("state-map.png"));
    assert_false(picture_exists("force.png.part"));
}

TEST(memory_runs_out_everywhere)
{
    PictureRequest request = {.style = {.dpi = 120}};
    int64_t live = memory_counters().live, k = 0;
    for (; k < FAULTS_MAX; ++k) {
        Error err = {0};
        memory_fail_after(k);
        bool done = amontons_render(folder, &request, &err);
        memory_fail_after(-1);
        assert_int_equal(memory_counters().live, live);
        if (done) break;
        assert_int_equal(err.code, ERROR_MEMORY);
    }
    assert_in_range(k, 20, FAULTS_MAX - 1);
}

TEST(figures_can_be_chosen)
{
    Error err = {0};
    const char *const names[] = {"contact-density"};
    char command[PATH_SIZE + 20];
    snprintf(command, sizeof command, "rm -rf '%s/figures'", folder);
    assert_int_equal(system(command), 0);
    PictureRequest request = {.figures = names, .figure_count = 1};
    assert_true(amontons_render(folder, &request, &err));
    assert_true(picture_exists("contact-density.png"));
    assert_false(picture_exists("force.png"));
}

TEST(unknown_figures_are_named)
{
    Error err = {0};
    const char *const names[] = {"force", "colour"};
    PictureRequest request = {.figures = names, .figure_count = 2};
    assert_false(amontons_render(folder, &request, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    assert_non_null(strstr(err.message, "\"colour\""));
    assert_non_null(strstr(err.message,
                           "force, slip-map, contact-density, contact-area, state-map, "
                           "contact-plane, precursors, front-speed, probes, pads, profile, field, "
                           "field-strip"));
}

GROUP_BETWEEN(result_write, result_remove);
