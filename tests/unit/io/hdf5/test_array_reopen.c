// SPDX-License-Identifier: GPL-2.0-or-later
// A file that is gone on with, finished or left by a process that died, holds in the end what one
// written at once holds; and what cannot be gone on with says so.
#include "io/hdf5/array_file.h"

#include "base/memory.h"
#include "io/files/own_list.h"
#include "near.h"
#include "result_place.h"

#include <fcntl.h>
#include <sys/syscall.h>
#include <sys/wait.h>

enum { WIDTH = 7, ROWS = 30000 };   // many chunks of either series

// Every write, rename and removal of the module and of HDF5 comes here (the test exports its
// symbols): a write that is due is done by half, the others not at all, and the process is killed.
static int64_t calls_left = -1;

static bool is_last(void)
{
    bool last = calls_left == 0;
    if (calls_left >= 0) calls_left--;
    return last;
}

static ssize_t write_at(long call, int file, const void *bytes, size_t size, off_t at)
{
    bool last = is_last();
    ssize_t count = syscall(call, file, bytes, last ? size / 2 : size, at);
    if (last) kill(getpid(), SIGKILL);
    return count;
}

ssize_t write(int file, const void *bytes, size_t size)
{
    return write_at(SYS_write, file, bytes, size, 0);
}

ssize_t pwrite(int file, const void *bytes, size_t size, off_t at)
{
    return write_at(SYS_pwrite64, file, bytes, size, at);
}

ssize_t pwrite64(int file, const void *bytes, size_t size, off64_t at)
{
    return write_at(SYS_pwrite64, file, bytes, size, at);
}

int rename(const char *from, const char *to)
{
    if (is_last()) kill(getpid(), SIGKILL);
    return (int)syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0);
}

int unlink(const char *path)
{
    if (is_last()) kill(getpid(), SIGKILL);
    return (int)syscall(SYS_unlinkat, AT_FDCWD, path, 0);
}

// A kill leaves what the disk has not got yet; waiting for it takes the test's time.
int fdatasync(int file)
{
    (void)file;
    return 0;
}

static double values[(int64_t)ROWS * WIDTH];

static void fill_values(void)
{
    for (int64_t k = 0; k < (int64_t)ROWS * WIDTH; k++) values[k] = (double)(k * k % 1009) / 7;
}

static const ArraySeries ONE = {
    .name = "a/scalar", .type = ARRAY_FLOAT64, .width = 1, .unit = "1", .description = ""};
static const ArraySeries WIDE = {
    .name = "wide", .type = ARRAY_FLOAT32, .width = WIDTH, .unit = "1", .description = ""};

static void add_series(ArrayFile *file, Error *err)
{
    assert_true(array_file_add_series(file, &ONE, err));
    assert_true(array_file_add_series(file, &WIDE, err));
}

static void take_up_and_cut(ArrayFile *file, int64_t kept, Error *err)
{
    assert_true(array_file_take_up(file, &ONE, 1, err));
    assert_true(array_file_take_up(file, &WIDE, 1, err));
    assert_true(array_file_cut(file, "a/scalar", kept, err));
    assert_true(array_file_cut(file, "wide", kept, err));
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
    take_up_and_cut(file, kept, &err);
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
        if (!array_file_flush(file, &err)) _exit(1);
        append(file, 12345, 25000, &err);
        kill(getpid(), SIGKILL);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFSIGNALED(status));
    go_on(path, 12000, ROWS);
    expect_rows(path, ROWS);
    place_remove(place);
}

// --- killed at any moment -----------------------------------------------------------------------

// A file of so many rows that is flushed after each `flushed` of them.
typedef struct Course {
    int64_t flushed, rows;
} Course;

// kept: rows that are gone on with; negative: a new file.
static void write_file(const char *path, const Course *course, int64_t kept, Error *err)
{
    ArrayFile *file = kept < 0 ? array_file_create(path, err) : array_file_reopen(path, err);
    if (!file) fail_msg("%s", err->message);
    if (kept < 0) add_series(file, err);
    if (kept >= 0) take_up_and_cut(file, kept, err);
    int64_t at = kept < 0 ? 0 : kept, end = course->rows;
    while (at < end) {
        int64_t next = at + course->flushed < end ? at + course->flushed : end;
        append(file, at, next, err);
        assert_true(array_file_flush(file, err));
        at = next;
    }
    assert_true(array_file_close(file, err));
}

static bool is_killed(const char *path, const Course *course, int64_t kept, int64_t calls)
{
    int status = 0;
    Error err = {0};
    pid_t child = fork();
    if (child == 0) {
        calls_left = calls;
        write_file(path, course, kept, &err);
        _exit(error_is_clean(&err) ? 0 : 1);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    if (WIFSIGNALED(status)) assert_int_equal(WTERMSIG(status), SIGKILL);
    if (!WIFSIGNALED(status)) assert_int_equal(WEXITSTATUS(status), 0);
    return WIFSIGNALED(status);
}

// Rows that can be read now; -1: nothing yet.
static int64_t flushed_rows(const char *path)
{
    Error err = {0};
    double *read = NULL;
    int64_t rows = 0;
    int32_t width = 0;
    ArrayFile *file = array_file_open(path, &err);
    if (!file) return -1;
    assert_true(array_file_read(file, "a/scalar", &read, &rows, &width, &err));
    memory_free(read);
    array_file_close(file, &err);
    return rows;
}

static void copy_file(const char *from, const char *to)
{
    static char bytes[1 << 16];
    size_t size;
    FILE *source = fopen(from, "rb"), *target = fopen(to, "wb");
    assert_true(source && target);
    while ((size = fread(bytes, 1, sizeof bytes, source)) > 0)
        assert_int_equal(fwrite(bytes, 1, size, target), size);
    fclose(source);
    assert_int_equal(fclose(target), 0);
}

// The rows of the last flush can be read, all series equally long, and continued. Where a file is
// continued (kept), that many rows are there at every moment.
static void kill_everywhere(const Course *course, int64_t kept)
{
    char stock[PLACE_SIZE], whole[2 * PLACE_SIZE], place[PLACE_SIZE], path[2 * PLACE_SIZE];
    const int64_t end = course->rows;
    int32_t kills = 0, readable = 0;
    Error err = {0};
    bool killed = true;
    fill_values();
    place_make(stock);
    snprintf(whole, sizeof whole, "%s", place_path(stock, "file.h5"));
    if (kept >= 0) write_file(whole, course, -1, &err);
    for (int64_t calls = 0; killed; calls++) {
        place_make(place);
        snprintf(path, sizeof path, "%s", place_path(place, "file.h5"));
        if (kept >= 0) copy_file(whole, path);
        killed = is_killed(path, course, kept, calls);
        int64_t rows = flushed_rows(path);
        kills += killed;
        readable += rows >= 0;
        if (rows >= 0) expect_rows(path, rows);
        assert_true(killed || rows == end);
        assert_true(kept < 0 || rows >= kept);
        // A little less than there is, as a checkpoint has it.
        int64_t taken = kept >= 0 ? kept : rows > 10 ? rows - 10 : rows;
        if (killed && rows >= 0) {
            write_file(path, course, taken, &err);
            expect_rows(path, end);
        }
        if (rows >= 0) assert_false(place_has(place, "file.h5.part"));
        place_remove(place);
    }
    place_remove(stock);
    print_message("%d kills, %d left a file\n", (int)kills, (int)readable);
    assert_true(kills >= 4 && readable >= kills / 2);
}

TEST(test_killed_at_every_call)
{
    kill_everywhere(&(Course){.flushed = 1100, .rows = 3300}, -1);
    kill_everywhere(&(Course){.flushed = 1100, .rows = 3300}, 1100);
}

// What a killed run of an earlier version left has the last rows only.
TEST(test_last_of_several_files_is_refused)
{
    Error err = {0};
    char place[PLACE_SIZE], path[2 * PLACE_SIZE];
    place_make(place);
    snprintf(path, sizeof path, "%s", place_path(place, "file.h5"));
    ArrayFile *file = array_file_create(path, &err);
    add_series(file, &err);
    assert_true(array_file_set_number(file, "parts", 1, &err));
    array_file_abandon(file);
    for (int32_t k = 0; k < 2; k++) {
        assert_null(k == 0 ? array_file_open(path, &err) : array_file_reopen(path, &err));
        assert_int_equal(err.code, ERROR_INPUT);
        assert_non_null(strstr(err.message, "file.h5.part.1, ...: the run was killed"));
        err = (Error){0};
    }
    assert_true(place_has(place, "file.h5.part"));
    place_remove(place);
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
    assert_non_null(strstr(err.message, "not a whole HDF5 file: file signature not found"));
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
    assert_false(array_file_cut(file, "a/scalar", 10, &err));   // not taken up
    assert_int_equal(err.code, ERROR_FILE);
    err = (Error){0};
    assert_true(array_file_take_up(file, &ONE, 1, &err));
    assert_false(array_file_cut(file, "a/scalar", 11, &err));
    assert_non_null(strstr(err.message, "has 10 rows, 11 are to be kept"));
    err = (Error){0};
    assert_false(array_file_cut(file, "b", 1, &err));
    assert_int_equal(err.code, ERROR_FILE);
    array_file_abandon(file);
    place_remove(place);
}

// A whole file with a hole behind it that is larger than any memory.
TEST(test_larger_than_memory)
{
    Error err = {0};
    char place[PLACE_SIZE], path[2 * PLACE_SIZE];
    place_make(place);
    assert_true(own_list_make(place, &err));
    snprintf(path, sizeof path, "%s", place_path(place, "file.h5"));
    ArrayFile *file = array_file_create(path, &err);
    add_series(file, &err);
    assert_true(array_file_close(file, &err));
    assert_int_equal(truncate(path, (off_t)1 << 42), 0);
    assert_null(array_file_reopen(path, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    assert_non_null(strstr(err.message, "of memory for two copies"));
    place_remove(place);
}

// A file may be anybody's: a series that is wider than the rows that are appended, or otherwise
// another one, is not taken up.
TEST(test_other_shapes)
{
    static const struct {
        ArraySeries series;
        int32_t components;
        const char *wanted;
    } cases[] = {
        {{.name = "wide", .type = ARRAY_FLOAT32, .width = WIDTH - 1}, 1, "7 numbers a row, not 6"},
        {{.name = "wide", .type = ARRAY_FLOAT32, .width = 1}, 1, "7 numbers a row, not 1"},
        {{.name = "wide", .type = ARRAY_FLOAT32, .width = WIDTH}, WIDTH, "type or shape"},
        {{.name = "wide", .type = ARRAY_FLOAT64, .width = WIDTH}, 1, "type or shape"},
        {{.name = "wide", .type = ARRAY_INT32, .width = WIDTH}, 1, "type or shape"},
        {{.name = "pairs", .type = ARRAY_FLOAT64, .width = 6}, 3, "type or shape"},
        {{.name = "pairs", .type = ARRAY_FLOAT64, .width = 6}, 1, "type or shape"},
        {{.name = "a/scalar", .type = ARRAY_FLOAT64, .width = 1000000}, 1, "1 numbers a row, not"},
        {{.name = "a", .type = ARRAY_FLOAT64, .width = 1}, 1, "has no a"},
        {{.name = "none", .type = ARRAY_FLOAT64, .width = 1}, 1, "has no none"}};
    static const ArraySeries pairs = {
        .name = "pairs", .type = ARRAY_FLOAT64, .width = 6, .unit = "1", .description = ""};
    Error err = {0};
    char place[PLACE_SIZE], path[2 * PLACE_SIZE];
    place_make(place);
    fill_values();
    snprintf(path, sizeof path, "%s", place_path(place, "file.h5"));
    int64_t live = memory_counters().live;
    ArrayFile *file = array_file_create(path, &err);
    add_series(file, &err);
    assert_true(array_file_add_vectors(file, &pairs, 2, &err));
    append(file, 0, 10, &err);
    assert_true(array_file_append(file, "pairs", values, 10, &err));
    assert_true(array_file_close(file, &err));
    file = array_file_reopen(path, &err);
    assert_non_null(file);
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        assert_false(array_file_take_up(file, &cases[k].series, cases[k].components, &err));
        if (!strstr(err.message, cases[k].wanted)) fail_msg("%s", err.message);
        assert_non_null(strstr(err.message, "file.h5.part: "));
        err = (Error){0};
    }
    take_up_and_cut(file, 5, &err);
    assert_true(array_file_take_up(file, &pairs, 2, &err));
    assert_false(array_file_take_up(file, &pairs, 2, &err));
    array_file_abandon(file);
    assert_int_equal(memory_counters().live, live);
    place_remove(place);
}
