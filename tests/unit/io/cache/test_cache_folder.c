// SPDX-License-Identifier: GPL-2.0-or-later
// The cache stays below its limit: the longest unused goes first, a file that was read counts as
// used, and what is not ours stays.
#include "io/cache/cache_folder.h"

#include "base/memory.h"
#include "io/cache/store.h"
#include "io/files/part_file.h"
#include "cache_fixture.h"

#include <fcntl.h>

// "aaaa...a.mesh", 32 times the letter.
static const char *name_of(char letter, const char *ending)
{
    static char name[64];
    memset(name, letter, 32);
    snprintf(name + 32, sizeof name - 32, ".%s", ending);
    return name;
}

// `bytes` long, last used so many seconds after 1970.
static void make_file(const char *name, int32_t bytes, time_t used)
{
    FILE *file = fopen(place_path(cache, name), "w");
    for (int32_t k = 0; k < bytes; k++) fputc('x', file);
    fclose(file);
    const struct timespec times[2] = {{.tv_sec = used}, {.tv_sec = 1}};
    assert_int_equal(utimensat(AT_FDCWD, place_path(cache, name), times, 0), 0);
}

static CacheFolder folder_now(void)
{
    Error err = {0};
    CacheFolder folder;
    assert_true(cache_folder_read(&folder, &err));
    return folder;
}

TEST_BETWEEN(test_longest_unused_goes_first, cache_begin, cache_end)
{
    int64_t live = memory_counters().live, bytes = 0;
    char keep[2 * PLACE_SIZE];
    make_file(name_of('b', "basis"), 300, 20);
    make_file(name_of('a', "mesh"), 100, 30);
    make_file(name_of('c', "modes"), 200, 10);
    make_file("notes.txt", 1000, 5);
    make_file(name_of('d', "lock"), 0, 40);   // of a process that was killed
    CacheFolder folder = folder_now();
    assert_int_equal(folder.count, 4);   // the other is not the cache's
    assert_int_equal(folder.bytes, 600);
    assert_string_equal(folder.entries[0].name, name_of('c', "modes"));
    assert_string_equal(folder.entries[2].name, name_of('a', "mesh"));
    assert_true(folder.entries[1].used == 20);
    assert_int_equal(cache_folder_trim(&folder, 600, NULL, &bytes), 0);   // not above it
    snprintf(keep, sizeof keep, "%s", place_path(cache, name_of('c', "modes")));
    assert_int_equal(cache_folder_trim(&folder, 500, keep, &bytes), 1);
    assert_int_equal(bytes, 300);
    assert_false(place_has(cache, name_of('b', "basis")));
    cache_folder_destroy(&folder);
    folder = folder_now();
    assert_int_equal(cache_folder_trim(&folder, -1, NULL, &bytes), 3);
    assert_true(place_has(cache, "notes.txt") && !place_has(cache, name_of('d', "lock")));
    cache_folder_destroy(&folder);
    assert_int_equal(memory_counters().live, live);
}

static void archive_values(void *values, Archive *archive)
{
    archive_numbers(archive, values, 100);
}

static void write_cache(char letter, double *values)
{
    char note[CACHE_NOTE_SIZE], key[33] = "";
    memset(key, letter, 32);
    assert_true(cache_store(&(CacheItem){CACHE_MESH, key, archive_values, values}, note));
}

static void read_cache(char letter)
{
    Error err = {0};
    char key[33] = "";
    double values[100];
    bool found = false;
    memset(key, letter, 32);
    const CacheItem item = {CACHE_MESH, key, archive_values, values};
    assert_true(cache_load(&item, &found, NULL, &err));
    assert_true(found);
}

// Three files of some 1000 bytes where there is room for two: the one that was read stays.
TEST_BETWEEN(test_writing_keeps_the_limit, cache_begin, cache_end)
{
    double values[100] = {0};
    const struct timespec old[2] = {{.tv_sec = 100}, {.tv_sec = 100}};
    const struct timespec newer[2] = {{.tv_sec = 200}, {.tv_sec = 200}};
    setenv("AMONTONS_CACHE_LIMIT", "2.5K", 1);
    write_cache('a', values);
    write_cache('b', values);
    utimensat(AT_FDCWD, place_path(cache, name_of('a', "mesh")), old, 0);
    utimensat(AT_FDCWD, place_path(cache, name_of('b', "mesh")), newer, 0);
    read_cache('a');
    write_cache('c', values);
    assert_true(place_has(cache, name_of('a', "mesh")));
    assert_false(place_has(cache, name_of('b', "mesh")));
    assert_true(place_has(cache, name_of('c', "mesh")));
    setenv("AMONTONS_CACHE_LIMIT", "0", 1);   // what was just written stays in any case
    write_cache('d', values);
    CacheFolder folder = folder_now();
    assert_int_equal(folder.count, 1);
    assert_string_equal(folder.entries[0].name, name_of('d', "mesh"));
    cache_folder_destroy(&folder);
}

static void make_part(PartFile *part, char letter)
{
    Error err = {0};
    assert_true(part_file_create(part, place_path(cache, name_of(letter, "basis")), &err));
    assert_true(part_file_write(part, "half", 4, &err));
}

// Files of a process that was killed while it wrote count, and go; those that one writes now stay.
TEST_BETWEEN(test_parts_of_killed_writers, cache_begin, cache_end)
{
    PartFile killed, writing;
    int64_t bytes = 0;
    make_part(&killed, 'a');
    part_file_leave(&killed);   // its lock ends with its process
    make_part(&writing, 'b');
    CacheFolder folder = folder_now();
    assert_int_equal(folder.count, 2);
    assert_int_equal(folder.bytes, 8);
    assert_int_equal(cache_folder_trim(&folder, 0, NULL, &bytes), 1);
    assert_int_equal(bytes, 4);
    assert_false(place_has(cache, name_of('a', "basis.part")));
    assert_false(place_has(cache, name_of('a', "basis")));
    assert_true(place_has(cache, name_of('b', "basis.part")));
    part_file_discard(&writing);
    cache_folder_destroy(&folder);
}

// A process does not look through the folder for each file that it writes: what another one puts
// there is met when an eighth of what was free is used: at most 80 kB, and a file has 800 bytes.
TEST_BETWEEN(test_looks_rarely, cache_begin, cache_end)
{
    enum { LIMIT = 640000, OTHERS = 1000000, EIGHTH = LIMIT / 8 / 800 + 1 };
    double values[100] = {0};
    setenv("AMONTONS_CACHE_LIMIT", "0", 1);
    write_cache('0', values);   // nothing is free: the next one looks
    setenv("AMONTONS_CACHE_LIMIT", "640K", 1);
    write_cache('1', values);
    make_file(name_of('e', "basis"), OTHERS, 10);
    write_cache('2', values);
    assert_true(place_has(cache, name_of('e', "basis")));
    for (int32_t k = 0; k < EIGHTH; k++) write_cache('3', values);
    assert_false(place_has(cache, name_of('e', "basis")));
    assert_true(place_has(cache, name_of('2', "mesh")));   // there was room, then
}

TEST_BETWEEN(test_limit, cache_begin, cache_end)
{
    const struct {
        const char *word;
        int64_t bytes;
    } cases[] = {{"500M", 500000000}, {"10G", 10000000000},       {"1.5K", 1500},
                 {"12", 12},          {"3500000000", 3500000000}, {"", 2000000000}};
    static const char *const wrong[] = {"much", "-1", "3X", "nan", "1e300", "2 G", "0x10", " 5"};
    Error err = {0};
    int64_t bytes = 0;
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        setenv("AMONTONS_CACHE_LIMIT", cases[k].word, 1);
        assert_true(cache_folder_limit(&bytes, &err));
        assert_int_equal(bytes, cases[k].bytes);
    }
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        err = (Error){0};
        setenv("AMONTONS_CACHE_LIMIT", wrong[k], 1);
        assert_false(cache_folder_limit(&bytes, &err));
        assert_int_equal(err.code, ERROR_INPUT);
        assert_non_null(strstr(err.message, wrong[k]));
    }
    unsetenv("AMONTONS_CACHE_LIMIT");
    err = (Error){0};
    assert_true(cache_folder_limit(&bytes, &err));
    assert_int_equal(bytes, 2000000000);
}

TEST_BETWEEN(test_no_folder, cache_begin, cache_end)
{
    setenv("AMONTONS_CACHE", place_path(cache, "not-there"), 1);
    CacheFolder folder = folder_now();
    assert_int_equal(folder.count, 0);
    setenv("AMONTONS_CACHE", "", 1);
    folder = folder_now();
    assert_string_equal(folder.path, "");
    char path[PATH_MAX], wanted[PATH_MAX];
    unsetenv("AMONTONS_CACHE");
    setenv("XDG_CACHE_HOME", cache, 1);
    snprintf(wanted, sizeof wanted, "%s/amontons", cache);
    assert_true(cache_folder_path(path));
    assert_string_equal(path, wanted);
    unsetenv("XDG_CACHE_HOME");
    setenv("HOME", cache, 1);
    snprintf(wanted, sizeof wanted, "%s/.cache/amontons", cache);
    assert_true(cache_folder_path(path));
    assert_string_equal(path, wanted);
    setenv("AMONTONS_CACHE", cache, 1);
}
