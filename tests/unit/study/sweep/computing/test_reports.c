// SPDX-License-Identifier: GPL-2.0-or-later
// One file of the reports of all points: lines are found again, what a kill cut off goes, what is
// none is passed over, and nothing is read beyond the end.
#include "study/sweep/computing/reports.h"

#include "base/hash.h"
#include "base/memory.h"
#include "result_place.h"

#include <string.h>

enum { LINES_MAX = 4 };

typedef struct Found {
    int32_t count;
    char hash[LINES_MAX][HASH_TEXT_SIZE];
    ReportPlace place[LINES_MAX];
} Found;

static void take(void *context, const char *hash, ReportPlace place)
{
    Found *found = context;
    assert_in_range(found->count, 0, LINES_MAX - 1);
    memcpy(found->hash[found->count], hash, HASH_TEXT_SIZE);
    found->place[found->count++] = place;
}

static void make_hash(char letter, char hash[HASH_TEXT_SIZE])
{
    memset(hash, letter, HASH_TEXT_SIZE - 1);
    hash[HASH_TEXT_SIZE - 1] = 0;
}

static void open_here(const char *place, bool anew, Reports *reports, Found *found)
{
    Error err = {0};
    *found = (Found){0};
    assert_true(reports_open(reports, place_path(place, "lines"), anew, &err));
    if (!reports_list(reports, take, found, &err)) fail_msg("%s", err.message);
}

static void assert_report(const Reports *reports, ReportPlace place, const char *wanted)
{
    Error err = {0};
    char *json = reports_read(reports, place, &err);
    if (!json) fail_msg("%s", err.message);
    assert_string_equal(json, wanted);
    memory_free(json);
}

// Its lowest bit.
static void change_byte(const char *path, int64_t at)
{
    FILE *file = fopen(path, "r+");
    assert_int_equal(fseek(file, at, SEEK_SET), 0);
    int byte = fgetc(file);
    assert_int_equal(fseek(file, at, SEEK_SET), 0);
    fputc(byte ^ 1, file);
    fclose(file);
}

TEST(test_lines)
{
    char place[PLACE_SIZE], a[HASH_TEXT_SIZE], b[HASH_TEXT_SIZE];
    Reports reports;
    Found found;
    ReportPlace first, second;
    Error err = {0};
    int64_t live = memory_counters().live;
    place_make(place);
    make_hash('a', a);
    make_hash('b', b);
    open_here(place, true, &reports, &found);
    assert_int_equal(found.count, 0);
    assert_true(reports_add(&reports, a, "{\"x\": 1}", &first, &err));
    assert_true(reports_add(&reports, b, "{}", &second, &err));
    assert_report(&reports, second, "{}");
    assert_report(&reports, first, "{\"x\": 1}");
    reports_close(&reports);

    FILE *file = fopen(place_path(place, "lines"), "a");
    fprintf(file, "somebody's own line\n%s \n%s {\"cut o", a, a);
    fclose(file);
    open_here(place, false, &reports, &found);
    assert_int_equal(found.count, 2);
    assert_string_equal(found.hash[0], a);
    assert_string_equal(found.hash[1], b);
    assert_report(&reports, found.place[0], "{\"x\": 1}");
    assert_true(reports_add(&reports, a, "{\"y\": 2}", &first, &err));   // where the cut line was
    assert_report(&reports, first, "{\"y\": 2}");
    reports_close(&reports);
    open_here(place, false, &reports, &found);
    assert_int_equal(found.count, 3);
    assert_int_equal(found.place[2].at, first.at);

    change_byte(place_path(place, "lines"), found.place[0].at + 6);   // {"x": 1} becomes {"x": 0}
    reports_close(&reports);
    open_here(place, false, &reports, &found);
    assert_int_equal(found.count, 2);
    assert_string_equal(found.hash[0], b);

    assert_null(reports_read(&reports, (ReportPlace){first.at + 4, first.size}, &err));
    assert_int_equal(err.code, ERROR_FILE);
    assert_non_null(strstr(err.message, "cannot read the reports of points"));
    reports_close(&reports);
    open_here(place, true, &reports, &found);   // anew: emptied
    assert_int_equal(found.count, 0);
    reports_close(&reports);
    reports_close(&reports);
    assert_int_equal(memory_counters().live, live);
    place_remove(place);
}

TEST(test_no_file)
{
    Reports reports;
    Error err = {0};
    assert_false(reports_open(&reports, "/proc/none/reports", false, &err));
    assert_int_equal(err.code, ERROR_FILE);
    reports_close(&reports);
}
