// SPDX-License-Identifier: GPL-2.0-or-later
// A file that is gone on with, finished or left by a process that died, holds in the end what one
// written at once holds; and what cannot be gone on with says so.
#include "io/hdf5/array_file.h"

#include "base/memory.h"
#include "io/files/own_list.h"
#include "near.h"
#include "result_place.h"

#include <errno.h>
#include <sys/syscall.h>
#include <sys/wait.h>

enum { WIDTH = 7, ROWS = 30000 };   // many chunks of either series

// Every write of the module comes here (the test exports its symbols): the one that is due is done
// by half, and kills the process.
static int64_t writes_left = -1;

ssize_t pwrite(int file, const void *bytes, size_t size, off_t at)
{
    bool last = writes_left == 0;
    if (writes_left >= 0) writes_left--;
    ssize_t count = syscall(SYS_pwrite64, file, bytes, last ? size / 2 : size, at);
    if (last) kill(getpid(), SIGKILL);
    return count;
}

ssize_t pwrite64(int file, const void *bytes, size_t size, off64_t at)
{
    return pwrite(file, bytes, size, at);
}

// And every close of HDF5.
static bool closing_fails = false;

int close(int file)
{
    long status = syscall(SYS_close, file);
    if (closing_fails) errno = EIO;
    return closing_fails ? -1 : (int)status;
}

static double values[(int64_t)ROWS * WIDTH];

static void fill_values(void)
{
    for (int64_t k = 0; k < (int64_t)ROWS * WIDTH; k++) values[k] = (double)(k * k % 1009) / 7;
}

static void add_series(ArrayFile *file, Error *err)
{
    const ArraySeries one = {
        .name = "a/scalar", .type = ARRAY_FLOAT64, .width = 1, .unit = "1", .description = ""};
    const ArraySeries wide = {
        .name = "wide", .type = ARRAY_FLOAT32, .width = WIDTH, .unit = "1", .description = ""};
    assert_true(array_file_add_series(file, &one, err));
    assert_true(array_file_add_series(file, &wide, err));
}

static void append(ArrayFile *file, int64_t from, int64_t to, Error *err)
{
    assert_true(array_file_append(file, "a/scalar", values + from, to - from, err));
    assert_true(array_file_append(file, "wide", values + from * WIDTH, to - from, err));
}

static void expect_rows(const char *path, int64_t count)
{
    Error err = {0};
    double *read = NULL;
    int64_t rows = 0;
    int32_t width = 0;
    ArrayFile *file = array_file_open(path, &err);
    if (!file) fail_msg("%s", err.message);
    assert_true(array_file_read(file, "a/scalar", &read, &rows, &width, &err));
    assert_true(rows == count && width == 1);
    assert_memory_equal(read, values, (size_t)rows * sizeof(double));
    memory_free(read);
    assert_true(array_file_read(file, "wide", &read, &rows, &width, &err));
    assert_true(rows == count && width == WIDTH);
    for (int64_t k = 0; k < rows * width; k++) assert_true(read[k] == (float)values[k]);
    memory_free(read);
    assert_false(array_file_has(file, "end"));
    assert_true(array_file_close(file, &err));
}

static void go_on(const char *path, int64_t kept, int64_t to)
{
    Error err = {0};
    ArrayFile *file = array_file_reopen(path, &err);
    if (!file) fail_msg("%s", err.message);
    assert_true(array_file_remove(file, "end", &err));
    assert_true(array_file_remove(file, "answer", &err));
    assert_true(array_file_remove(file, "nothing", &err));
    assert_true(array_file_cut(file, "a/scalar", kept, &err));
    assert_true(array_file_cut(file, "wide", kept, &err));
    append(file, kept, to, &err);
    assert_true(array_file_close(file, &err));
}

// With a table and a number of its end, which go.
TEST(test_finished)
{
    Error err = {0};
    char place[PLACE_SIZE], path[2 * PLACE_SIZE];
    place_make(place);
    fill_values();
    snprintf(path, sizeof path, "%s", place_path(place, "file.h5"));
    ArrayFile *file = array_file_create(path, &err);
    const ArraySeries table = {
        .name = "end", .type = ARRAY_FLOAT64, .width = 1, .unit = "1", .description = ""};
    add_series(file, &err);
    append(file, 0, 20000, &err);
    assert_true(array_file_add_series(file, &table, &err));
    assert_true(array_file_append(file, "end", values, 5, &err));
    assert_true(array_file_set_number(file, "answer", 3, &err));
    assert_true(array_file_close(file, &err));
    // Within a chunk, at its end, and to nothing; also without anything being appended.
    const int64_t kept[][2] = {{17001, ROWS}, {10240, 20000}, {20000, 20000}, {1, 1}, {0, 3000}};
    for (size_t k = 0; k < sizeof kept / sizeof kept[0]; k++) {
        go_on(path, kept[k][0], kept[k][1]);
        expect_rows(path, kept[k][1]);
        assert_false(place_has(place, "file.h5.part"));
    }
    place_remove(place);
}

// Left by a process that died after more than was flushed.
TEST(test_killed)
{
    char place[PLACE_SIZE], path[2 * PLACE_SIZE];
    int status = 0;
    place_make(place);
    fill_values();
    snprintf(path, sizeof path, "%s", place_path(place, "file.h5"));
    pid_t child = fork();
    if (child == 0) {
        Error err = {0};
        ArrayFile *file = array_file_create(path, &err);
        add_series(file, &err);
        append(file, 0, 12345, &err);
        if (!array_file_sync(file, &err)) _exit(1);
        append(file, 12345, 25000, &err);
        kill(getpid(), SIGKILL);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFSIGNALED(status));
    go_on(path, 12000, ROWS);
    expect_rows(path, ROWS);
    place_remove(place);
}

// Flushes after FLUSHED rows, twice and thrice as many.
enum { FLUSHED = 1100, FLUSHES = 3 };

static _Noreturn void write_until_killed(const char *path, bool anew, int64_t writes)
{
    Error err = {0};
    writes_left = writes;
    ArrayFile *file = anew ? array_file_create(path, &err) : array_file_reopen(path, &err);
    if (!file) _exit(1);
    if (anew) add_series(file, &err);
    if (!anew) array_file_cut(file, "a/scalar", FLUSHED, &err);
    if (!anew) array_file_cut(file, "wide", FLUSHED, &err);
    for (int64_t k = anew ? 0 : 1; k < FLUSHES; k++) {
        append(file, k * FLUSHED, (k + 1) * FLUSHED, &err);
        if (!array_file_flush(file, &err)) _exit(1);
    }
    array_file_close(file, &err);
    _exit(0);
}

static bool is_killed(const char *path, bool anew, int64_t writes)
{
    int status = 0;
    pid_t child = fork();
    if (child == 0) write_until_killed(path, anew, writes);
    assert_int_equal(waitpid(child, &status, 0), child);
    if (WIFSIGNALED(status)) assert_int_equal(WTERMSIG(status), SIGKILL);
    if (!WIFSIGNALED(status)) assert_int_equal(WEXITSTATUS(status), 0);
    return WIFSIGNALED(status);
}

// What can be read now: so many whole flushes, the same for every series; -1: none yet.
static int64_t flushed_rows(const char *path)
{
    Error err = {0};
    double *read = NULL;
    int64_t rows = 0;
    int32_t width = 0;
    ArrayFile *file = array_file_open(path, &err);
    if (!file) return -1;
    if (array_file_has(file, "wide"))
        assert_true(array_file_read(file, "wide", &read, &rows, &width, &err));
    memory_free(read);
    array_file_close(file, &err);
    if (rows > 0) expect_rows(path, rows);
    assert_true(rows % FLUSHED == 0);
    return rows;
}

// At every write there is: what the last flush left can be read and gone on with; also where it was
// being gone on with.
TEST(test_killed_at_every_write)
{
    char place[PLACE_SIZE], path[2 * PLACE_SIZE];
    bool anew = true;
    int64_t before = -1, mid_flush = 0;
    fill_values();
    for (int64_t writes = 0;; writes++) {
        place_make(place);
        snprintf(path, sizeof path, "%s", place_path(place, "file.h5"));
        if (!anew) assert_true(is_killed(path, true, before));
        bool killed = is_killed(path, anew, writes);
        int64_t rows = flushed_rows(path);
        mid_flush += place_has(place, "file.h5.journal");
        if (rows >= FLUSHED) {
            if (killed && anew && before < 0) before = writes;
            go_on(path, FLUSHED, 2 * FLUSHED);
            expect_rows(path, 2 * FLUSHED);
            assert_false(place_has(place, "file.h5.journal"));
        } else {
            assert_true(anew && before < 0);
        }
        place_remove(place);
        if (killed) continue;
        if (!anew) break;
        anew = false;
        writes = -1;
    }
    assert_true(before > 0 && mid_flush > 20);
}

// Missing, no HDF5 file, fewer rows, no such series, being written.
TEST(test_refused)
{
    Error err = {0};
    char place[PLACE_SIZE], path[2 * PLACE_SIZE];
    place_make(place);
    assert_true(own_list_make(place, &err));
    snprintf(path, sizeof path, "%s", place_path(place, "file.h5"));
    assert_true(own_list_add(path, &err));
    assert_null(array_file_reopen(path, &err));
    assert_int_equal(err.code, ERROR_FILE);
    err = (Error){0};
    place_write(place, "file.h5", "no HDF5 file, but long enough to have a header of one");
    assert_null(array_file_reopen(path, &err));
    assert_non_null(strstr(err.message, "not a whole HDF5 file"));
    assert_true(place_has(place, "file.h5.part"));
    err = (Error){0};
    ArrayFile *file = array_file_create(path, &err);
    add_series(file, &err);
    append(file, 0, 10, &err);
    assert_null(array_file_reopen(path, &err));
    assert_non_null(strstr(err.message, "another process is writing"));
    err = (Error){0};
    assert_true(array_file_close(file, &err));
    file = array_file_reopen(path, &err);
    assert_false(array_file_cut(file, "a/scalar", 11, &err));
    assert_non_null(strstr(err.message, "has 10 rows, 11 are to be kept"));
    err = (Error){0};
    assert_false(array_file_cut(file, "b", 1, &err));
    assert_int_equal(err.code, ERROR_FILE);
    array_file_abandon(file);
    place_remove(place);
}

// HDF5 1.10 keeps half a file whose descriptor does not close, and crashes on it at the program's
// end: that of this test.
TEST(test_a_read_file_that_does_not_close)
{
    Error err = {0};
    char place[PLACE_SIZE], path[2 * PLACE_SIZE];
    place_make(place);
    snprintf(path, sizeof path, "%s", place_path(place, "file.h5"));
    ArrayFile *file = array_file_create(path, &err);
    add_series(file, &err);
    append(file, 0, 10, &err);
    assert_true(array_file_close(file, &err));
    file = array_file_open(path, &err);
    assert_non_null(file);
    closing_fails = true;
    array_file_close(file, &err);
    closing_fails = false;
    place_remove(place);
}
