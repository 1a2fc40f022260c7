// SPDX-License-Identifier: GPL-2.0-or-later
// A cache file is read back to the bit or not at all: cut, changed, foreign and half-written ones
// are refused with a reason, and writers do not disturb each other.
#include "io/cache/cache_file.h"

#include "base/memory.h"
#include "near.h"
#include "random_numbers.h"

#include <dirent.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static const char KEY[] = "0123456789abcdef0123456789abcdef";
static const char OTHER[] = "0123456789abcdef0123456789abcdee";
enum { LONG_ARRAY = 1000, FOLDER_SIZE = 64, PATH_SIZE = 128 };

static char folder[FOLDER_SIZE];

static int make_folder(void **state)
{
    (void)state;
    snprintf(folder, sizeof folder, "/tmp/amontons-cache-XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

static int remove_folder(void **state)
{
    (void)state;
    char command[FOLDER_SIZE + 16];
    snprintf(command, sizeof command, "rm -rf %s", folder);
    return system(command);
}

static void path_in_folder(const char *name, char path[PATH_SIZE])
{
    snprintf(path, PATH_SIZE, "%s/%s", folder, name);
}

// Files in the folder whose name ends in `ending`.
static int32_t count_files(const char *ending)
{
    DIR *listing = opendir(folder);
    int32_t count = 0;
    for (struct dirent *entry; (entry = readdir(listing));) {
        size_t length = strlen(entry->d_name), tail = strlen(ending);
        count += length >= tail && strcmp(entry->d_name + length - tail, ending) == 0;
    }
    closedir(listing);
    return count;
}

typedef struct Written {
    double numbers[LONG_ARRAY], odd[6];
    CacheArray arrays[4];
} Written;

static void fill_arrays(Written *written)
{
    Random random = {.state = 31};
    *written = (Written){.odd = {-0.0, INFINITY, NAN, 5e-324, 0x1.fffffffffffffp1023, 1. / 3}};
    for (int32_t k = 0; k < LONG_ARRAY; k++) written->numbers[k] = random_between(&random, -1, 1);
    CacheArray arrays[4] = {{"numbers", LONG_ARRAY, written->numbers},
                            {"none", 0, NULL},
                            {"odd", 6, written->odd},
                            {"a name of thirty-one characters", 1, written->numbers}};
    memcpy(written->arrays, arrays, sizeof arrays);
}

static void write_file(const char *path, const char *key, const Written *written)
{
    Error err = {0};
    if (!cache_file_write(path, key, written->arrays, 4, &err)) fail_msg("%s", err.message);
}

// Reads `path`; *reason is empty where it is good or missing.
static bool read_file(const char *path, const char *key, CacheFile *file, char *reason)
{
    Error err = {0};
    bool found = true;
    memset(reason, 'x', CACHE_REASON_SIZE);
    if (!cache_file_read(path, key, file, &found, reason, &err)) fail_msg("%s", err.message);
    assert_non_null(memchr(reason, 0, CACHE_REASON_SIZE));
    return found;
}

static void assert_refused(const char *path, const char *key, const char *what)
{
    CacheFile file;
    char reason[CACHE_REASON_SIZE];
    int64_t live = memory_counters().live;
    if (read_file(path, key, &file, reason)) fail_msg("%s is trusted", what);
    if (!reason[0]) fail_msg("%s is refused without a reason", what);
    assert_null(file.bytes);
    assert_int_equal(file.array_count, 0);
    assert_int_equal(memory_counters().live, live);
}

static void test_round_trip(void **state)
{
    (void)state;
    Written written;
    CacheFile file;
    char path[PATH_SIZE], reason[CACHE_REASON_SIZE];
    int64_t live = memory_counters().live;
    fill_arrays(&written);
    path_in_folder("trip", path);
    assert_false(read_file(path, KEY, &file, reason));   // missing is no fault
    assert_string_equal(reason, "");
    for (int round = 0; round < 2; round++) {   // over itself, too
        write_file(path, KEY, &written);
        assert_true(read_file(path, KEY, &file, reason));
        assert_string_equal(reason, "");
        assert_int_equal(file.array_count, 4);
        for (int32_t k = 0; k < 4; k++) {
            const CacheArray *array = &written.arrays[k];
            const double *values = cache_file_array(&file, array->name, array->count);
            assert_non_null(values);
            assert_ptr_equal(values, cache_file_array(&file, array->name, -1));
            assert_int_equal((uintptr_t)values % 64, 0);   // as a basis that was just made
            if (array->count > 0)
                assert_memory_equal(values, array->values, (size_t)array->count * sizeof(double));
            assert_null(cache_file_array(&file, array->name, array->count + 1));
            if (array->count > 0)
                assert_null(cache_file_array(&file, array->name, array->count - 1));
        }
        assert_null(cache_file_array(&file, "number", -1));
        assert_null(cache_file_array(&file, "numbers2", -1));
        assert_null(cache_file_array(&file, "end", -1));
        cache_file_destroy(&file);
    }
    assert_int_equal(count_files(".part"), 0);
    assert_int_equal(memory_counters().live, live);
}

static char *slurp(const char *path, size_t *size)
{
    FILE *stream = fopen(path, "rb");
    char *bytes = malloc(1 << 16);
    *size = fread(bytes, 1, 1 << 16, stream);
    fclose(stream);
    return bytes;
}

static void spill(const char *path, const char *bytes, size_t size)
{
    FILE *stream = fopen(path, "wb");
    assert_int_equal(fwrite(bytes, 1, size, stream), size);
    fclose(stream);
}

// Every length below the whole, and some above it.
static void test_every_cut(void **state)
{
    (void)state;
    Written written;
    char path[PATH_SIZE];
    size_t size;
    fill_arrays(&written);
    written.arrays[0].count = 40;
    path_in_folder("cut", path);
    write_file(path, KEY, &written);
    char *bytes = slurp(path, &size);
    assert_int_equal(size, 64 + 5 * 64 + (40 + 8 + 8) * 8 + 32);   // whole lines of 64 bytes
    for (size_t length = 0; length < size; length++) {
        spill(path, bytes, length);
        assert_refused(path, KEY, "a cut file");
    }
    memset(bytes + size, 0, 100);
    for (size_t more = 1; more <= 100; more += 33) {
        spill(path, bytes, size + more);
        assert_refused(path, KEY, "a file with something behind its end");
    }
    free(bytes);
}

// One bit in each byte, and each byte set to values that numbers of entries are sensitive to.
static void test_every_byte(void **state)
{
    (void)state;
    Written written;
    CacheFile file;
    char path[PATH_SIZE], reason[CACHE_REASON_SIZE];
    size_t size;
    fill_arrays(&written);
    written.arrays[0].count = 40;
    path_in_folder("flipped", path);
    write_file(path, KEY, &written);
    char *bytes = slurp(path, &size);
    const unsigned char values[] = {0x00, 0x7f, 0x80, 0xff};
    for (size_t at = 0; at < size; at++) {
        char kept = bytes[at];
        bytes[at] = (char)(kept ^ (1 << at % 8));
        spill(path, bytes, size);
        assert_refused(path, KEY, "a flipped bit");
        for (size_t v = 0; v < sizeof values; v++) {
            bytes[at] = (char)values[v];
            if (bytes[at] == kept) continue;
            spill(path, bytes, size);
            assert_refused(path, KEY, "a changed byte");
        }
        bytes[at] = kept;
    }
    spill(path, bytes, size);
    assert_true(read_file(path, KEY, &file, reason));   // it was the byte, not the test
    cache_file_destroy(&file);
    // Counts that would reach beyond the file, or wrap around.
    const int64_t counts[] = {41, 1000, INT64_MAX, INT64_MAX / 8 + 1, INT64_MIN, -2, 1LL << 61};
    for (size_t k = 0; k < sizeof counts / sizeof *counts; k++) {
        memcpy(bytes + 64 + CACHE_NAME_SIZE, &counts[k], sizeof counts[k]);
        spill(path, bytes, size);
        assert_refused(path, KEY, "a wrong count");
    }
    free(bytes);
}

static void test_foreign_files(void **state)
{
    (void)state;
    Written written;
    CacheFile file;
    char path[PATH_SIZE], reason[CACHE_REASON_SIZE];
    fill_arrays(&written);
    path_in_folder("foreign", path);
    write_file(path, KEY, &written);
    assert_false(read_file(path, OTHER, &file, reason));
    assert_string_equal(reason, "it belongs to another shape");
    size_t size;
    char *bytes = slurp(path, &size);
    bytes[15]++;   // the version's digit
    spill(path, bytes, size);
    assert_false(read_file(path, KEY, &file, reason));
    assert_string_equal(reason, "it is not a cache file of this version");
    free(bytes);
    char *junk = malloc(1 << 16);
    Random random = {.state = 32};
    for (int32_t trial = 0; trial < 20; trial++) {
        for (int32_t k = 0; k < 1 << 16; k++) junk[k] = (char)random_bits(&random);
        if (trial % 2) memcpy(junk, "amontons-cache 2\n", 17);
        if (trial % 4 == 3) memcpy(junk + 17, KEY, 32);
        if (trial % 4 == 3) memset(junk + 49, 0, 15);
        spill(path, junk, (size_t)random_index(&random, 1 << 16) + 200);
        assert_refused(path, KEY, "junk");
    }
    free(junk);
    path_in_folder("a folder", path);   // as good as missing
    assert_int_equal(mkdir(path, 0777), 0);
    assert_false(read_file(path, KEY, &file, reason));
}

// Four processes write the same file over and over; a reader beside them sees a whole file or none.
static void test_many_writers(void **state)
{
    (void)state;
    enum { WRITERS = 4, ROUNDS = 25 };
    char path[PATH_SIZE], reason[CACHE_REASON_SIZE];
    Written written;
    pid_t child[WRITERS];
    fill_arrays(&written);
    path_in_folder("shared", path);
    for (int w = 0; w < WRITERS; w++) {
        child[w] = fork();
        if (child[w] != 0) continue;
        for (int32_t round = 0; round < ROUNDS; round++) {
            Error err = {0};
            written.numbers[0] = w;
            if (!cache_file_write(path, KEY, written.arrays, 4, &err)) _exit(1);
        }
        _exit(0);
    }
    int32_t failed = 0, seen = 0;
    // On a busy machine all may have ended before the first look: then that is the last, too.
    for (int32_t left = WRITERS; left > 0 || seen == 0;) {
        CacheFile file;
        int status;
        if (read_file(path, KEY, &file, reason)) {
            seen++;
            const double *values = cache_file_array(&file, "numbers", LONG_ARRAY);
            assert_non_null(values);
            assert_true(values[0] >= 0 && values[0] < WRITERS);
            assert_memory_equal(values + 1, written.numbers + 1, (LONG_ARRAY - 1) * sizeof(double));
        }
        assert_string_equal(reason, "");
        cache_file_destroy(&file);
        pid_t ended = waitpid(-1, &status, WNOHANG);
        if (ended <= 0) continue;
        failed += !(WIFEXITED(status) && WEXITSTATUS(status) == 0);
        left--;
    }
    assert_int_equal(failed, 0);   // who comes second gives way, without an error
    assert_true(seen > 0);
    CacheFile file;
    assert_true(read_file(path, KEY, &file, reason));
    cache_file_destroy(&file);
    assert_int_equal(count_files(".part"), 0);
}

// Nowhere to write to: an error that says so, and nothing left behind.
static void test_no_room(void **state)
{
    (void)state;
    Error err = {0};
    Written written;
    char path[PATH_SIZE];
    fill_arrays(&written);
    path_in_folder("missing/file", path);
    assert_false(cache_file_write(path, KEY, written.arrays, 4, &err));
    assert_int_equal(err.code, ERROR_FILE);
    assert_non_null(strstr(err.message, "No such file"));
    error_clear(&err);
    path_in_folder("taken", path);   // by a folder
    assert_int_equal(mkdir(path, 0777), 0);
    assert_false(cache_file_write(path, KEY, written.arrays, 4, &err));
    assert_int_equal(err.code, ERROR_FILE);
    assert_int_equal(count_files(".part"), 0);
}

static void test_memory_faults(void **state)
{
    (void)state;
    Written written;
    char path[PATH_SIZE], reason[CACHE_REASON_SIZE];
    fill_arrays(&written);
    path_in_folder("fault", path);
    write_file(path, KEY, &written);
    int64_t live = memory_counters().live;
    bool done = false, found;
    for (int32_t k = 0; !done; k++) {
        Error err = {0};
        CacheFile file;
        memory_fail_after(k);
        done = cache_file_read(path, KEY, &file, &found, reason, &err);
        memory_fail_after(-1);
        assert_int_equal(err.code, done ? ERROR_NONE : ERROR_MEMORY);
        assert_int_equal(found, done);
        cache_file_destroy(&file);
        assert_int_equal(memory_counters().live, live);
        assert_true(k < 5);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_round_trip),    cmocka_unit_test(test_every_cut),
        cmocka_unit_test(test_every_byte),    cmocka_unit_test(test_foreign_files),
        cmocka_unit_test(test_many_writers),  cmocka_unit_test(test_no_room),
        cmocka_unit_test(test_memory_faults),
    };
    return cmocka_run_group_tests(tests, make_folder, remove_folder);
}
