// SPDX-License-Identifier: GPL-2.0-or-later
// Pages about results written by hand, which lack what a whole result has: each says what there is,
// and shows no more. (What a page of a real result holds is looked at by end_to_end.report.)
#include "amontons.h"

#include "base/memory.h"
#include "io/hdf5/result_file.h"
#include "place_fixture.h"

enum { EVENTS_MAX = 400 };

static char *page_of(const char *const *results, int32_t count)
{
    static char text[1 << 18];
    char file[PLACE_SIZE + 20];
    Error err = {0};
    int64_t live = memory_counters().live;
    snprintf(file, sizeof file, "%s/page.html", place);
    if (!amontons_report(results, count, file, NULL, &err)) fail_msg("%s", err.message);
    assert_int_equal(memory_counters().live, live);
    place_read(place, "page.html", text, sizeof text);
    unlink(file);
    return text;
}

static void expect(const char *page, const char *words)
{
    if (!strstr(page, words)) fail_msg("not on the page: %s", words);
}

static void expect_not(const char *page, const char *words)
{
    if (strstr(page, words)) fail_msg("on the page: %s", words);
}

static const char *here(void)
{
    return place;
}

static char *page_here(void)
{
    const char *const results[] = {here()};
    return page_of(results, 1);
}

static void refuse(const char *const *results, int32_t count, const char *words)
{
    char file[PLACE_SIZE + 20];
    Error err = {0};
    snprintf(file, sizeof file, "%s/page.html", place);
    assert_false(amontons_report(results, count, file, NULL, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    if (!strstr(err.message, words)) fail_msg("%s", err.message);
    assert_false(place_has(place, "page.html") || place_has(place, "page.html.part"));
}

TEST_BETWEEN(test_refused, begin, end)
{
    const char *const results[] = {here()};
    refuse(results, 0, "a report needs a result folder");
    refuse(results, 1, "not the result of a run or a sweep");
    place_write(place, "run.json", "{\"status\": \"done\"");
    refuse(results, 1, "ends before its last bracket");
    place_write(place, "sweep.csv", "a,b\n1,2\n");
    refuse(results, 1, "is no table of a sweep");
    place_write(place, "sweep.csv", "status,b\ndone,2\n");
    refuse(results, 1, "is no table of a sweep");
    char file[PLACE_SIZE + 20];
    Error err = {0};
    snprintf(file, sizeof file, "%s/page.html", place);
    place_write(place, "page.html.part", "of somebody");   // is neither used nor removed
    assert_false(amontons_report(results, 1, file, NULL, &err));
    assert_non_null(strstr(err.message, "page.html.part is there already"));
    assert_true(place_has(place, "page.html.part"));
}

// A report alone: its numbers, its scene; nothing of a history.
TEST_BETWEEN(test_run_of_a_report_alone, begin, end)
{
    place_write(place, "run.json",
                "{\n  \"version\": \"0.0\",\n  \"status\": \"done\",\n  \"scene\": {\n"
                "    \"title\": \"By <hand>\",\n    \"groups\": {\"top\": [\"a\",\n      \"b\"], "
                "\"none\": []},\n    \"friction\": {\"law\": \"coulomb\", \"mu_static\": 0.5},\n"
                "    \"output\": {\"history\": false, \"end\": null}\n  },\n"
                "  \"results\": {\"mu_M\": -0.25, \"mu_M_error\": 0.003}\n}\n");
    const char *page = page_here();
    expect(page, "By &lt;hand&gt;");
    expect_not(page, "<hand>");
    expect(page, "\u22120.250<");   // a digit below what is known
    expect(page, "there is no error bar");
    expect_not(page, "&nbsp;\u00b1");
    expect(page, "[&quot;a&quot;, &quot;b&quot;]");   // of a list of several lines one
    expect_not(page, "id='events'");
}

TEST_BETWEEN(test_run_that_failed, begin, end)
{
    place_write(place, "run.json", "{\"status\": \"failed\", \"message\": \"it broke\"}");
    const char *page = page_here();
    expect(page, "it broke");
    expect(page, "did not slide");
}

static const char *const TABLE =
    "point,run,status,load.pressure,mu_M,mu_M_error,alone_error,message,"
    "warnings\n";

static void write_table(const char *rows)
{
    char text[4000];
    snprintf(text, sizeof text, "%s%s", TABLE, rows);
    place_write(place, "sweep.csv", text);
}

// Nothing is done yet: no scene, no numbers of one.
TEST_BETWEEN(test_sweep_that_has_not_begun, begin, end)
{
    write_table("0,p0,pending,0.003,,,,,\n1,p1,failed,0.006,,,,no <way>,\n");
    const char *page = page_here();
    expect(page, "0 of 2 points are done, 1 failed, 1 are not computed yet");
    expect(page, "<th scope='row'>1</th><td>no &lt;way&gt;</td>");
    expect_not(page, "That of the first point that is done");
    expect(page, "<th scope='col'>alone_error</th>");   // of what is not in the table
    expect_not(page, "<th scope='col'>mu_M_error</th>");
}

// Each sentence that points warned of stands there once; a figure that is none is told of.
TEST_BETWEEN(test_sweep_that_is_done, begin, end)
{
    char rows[3000], path[PLACE_SIZE + 20];
    snprintf(path, sizeof path, "%s/p0", place);
    assert_int_equal(mkdir(path, 0700), 0);
    place_write(place, "p0/run.json",
                "{\"version\": \"0.0\", \"status\": \"done\", \"scene\": {\"title\": \"First\", "
                "\"accuracy\": {\"mu\": 0.01}}}");
    snprintf(path, sizeof path, "%s/figures", place);
    assert_int_equal(mkdir(path, 0700), 0);
    place_write(place, "figures/ranking.json", "{}");
    place_write(place, "figures/notes.txt", "");
    snprintf(rows, sizeof rows,
             "0,p0,done,0.003,0.3,0.01,,,one // two %01200d\n1,p1,done,0.006,0.4,,,,one\n", 7);
    write_table(rows);
    const char *page = page_here();
    expect(page, "2 runs of an elastic block");
    expect(page, "(First)");
    expect(page, "No point failed.");
    expect_not(page, "points are done");
    expect_not(page, "leaves out the mesh");   // an error bar was asked for
    expect(page, "ranking.json");   // why there is no picture
    expect(page, "0.300&nbsp;\u00b1&nbsp;0.010");
    expect(page, "two 000");
}

// Runs that have no history have no curve, and one that failed has no numbers.
TEST_BETWEEN(test_comparison, begin, end)
{
    char paths[2][PLACE_SIZE + 20];
    const char *const results[] = {paths[0], paths[1]};
    for (int k = 0; k < 2; k++) {
        snprintf(paths[k], sizeof paths[k], "%s/run%d", place, k);
        assert_int_equal(mkdir(paths[k], 0700), 0);
    }
    place_write(place, "run0/run.json", "{\"status\": \"failed\", \"scene\": {\"units\": \"si\"}}");
    place_write(place, "run1/run.json",
                "{\"status\": \"done\", \"scene\": {}, \"warnings\": [\"mind <this>\"]}");
    const char *page = page_of(results, 2);
    expect(page, "run0 failed: its own report says why");
    expect(page, "run1: mind &lt;this&gt;");
    expect(page, "2 of 2 runs kept no history");
    place_write(place, "run1/sweep.csv", "");
    refuse(results, 2, "only runs are compared");
}

// Three states at two nodes and `count` events of these kinds, the last at U = 0.1 count.
static void write_history(const char *name, const char *units, const double *kinds, int32_t count)
{
    static const double x[] = {0, 1}, pad[] = {0, 0};
    static const double rod[] = {0, 0.25, 0.5}, mu[] = {0, 0.375, 0.125};
    double numbers[EVENTS_MAX];
    char folder[PLACE_SIZE + 20];
    ResultHead head = {.title = "By hand",
                       .units = units,
                       .version = "0",
                       .contact_count = 2,
                       .nodes = {[NODES_X] = x, [NODES_WEIGHT] = x, [NODES_PAD] = pad}};
    Error err = {0};
    for (int32_t k = 0; k < count; k++) numbers[k] = (k + 1) / 10.;
    snprintf(folder, sizeof folder, "%s/%s", place, name);
    ArrayFile *file = result_file_create(folder, &head, &err);
    if (!file) fail_msg("%s", err.message);
    array_file_append(file, result_series_name(SERIES_TIME), rod, 3, &err);
    array_file_append(file, result_series_name(SERIES_ROD), rod, 3, &err);
    array_file_append(file, result_series_name(SERIES_MU), mu, 3, &err);
    for (int32_t table = EVENTS_KIND; table < RESULT_TABLES_COUNT; table++)
        result_file_write_table(file, (ResultTable)table, table == EVENTS_KIND ? kinds : numbers,
                                count, &err);
    if (!array_file_close(file, &err)) fail_msg("%s", err.message);
}

// The last 300 of them, by the names of their kinds.
TEST_BETWEEN(test_many_events, begin, end)
{
    double kinds[EVENTS_MAX] = {0};
    kinds[EVENTS_MAX - 1] = 3;
    kinds[EVENTS_MAX - 2] = 1;
    kinds[EVENTS_MAX - 3] = 2;
    write_history("", "normalised", kinds, EVENTS_MAX);
    place_write(place, "run.json", "{\"status\": \"done\", \"scene\": {}}");
    const char *page = page_here();
    expect(page, "The last 300 of 400; all are in run.json.");
    expect(page, ">101</td><td>quasi-static<");
    expect_not(page, ">100</td><td>quasi-static<");
    expect(page, ">398</td><td>bulk sliding<");
    expect(page, ">399</td><td>bounded rapid<");
    expect(page, ">400</td><td>slight rapid<");
}

TEST_BETWEEN(test_without_events, begin, end)
{
    write_history("", "normalised", NULL, 0);
    expect(page_here(), "Events are known at the end of a run.");   // no run.json
    place_write(place, "run.json", "{\"status\": \"done\", \"scene\": {}}");
    expect(page_here(), "None in this run.");
}

// Metres and lengths over L have no axis in common.
TEST_BETWEEN(test_units_that_differ, begin, end)
{
    char paths[2][PLACE_SIZE + 20];
    const char *const results[] = {paths[0], paths[1]};
    for (int k = 0; k < 2; k++) {
        char name[8], report[20];
        snprintf(name, sizeof name, "run%d", k);
        snprintf(paths[k], sizeof paths[k], "%s/%s", place, name);
        assert_int_equal(mkdir(paths[k], 0700), 0);
        write_history(name, k ? "si" : "normalised", NULL, 0);
        snprintf(report, sizeof report, "%s/run.json", name);
        place_write(place, report,
                    k ? "{\"status\": \"done\", \"scene\": {\"units\": \"si\"}}"
                      : "{\"status\": \"done\", \"scene\": {\"units\": \"normalised\"}}");
    }
    expect(page_of(results, 2), "their curves have no common axis");
}
