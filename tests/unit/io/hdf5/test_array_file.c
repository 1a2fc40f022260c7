// SPDX-License-Identifier: GPL-2.0-or-later
// All that is written is read back, whatever kills the writer. HDF5 is asked directly for what h5py
// would see; the limit on file size stands in for a full disk.
#include "io/hdf5/array_file.h"

#include "base/memory.h"
#include "cases.h"
#include "io/files/own_list.h"

#include <hdf5.h>

#include <math.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { WIDTH = 81, PATH_SIZE = 200 };

static char folder[64];

FIXTURE(make_folder)
{
    snprintf(folder, sizeof folder, "/tmp/amontons_array_XXXXXX");
    return mkdtemp(folder) && own_list_make(folder, &(Error){0}) ? 0 : -1;
}

FIXTURE(remove_folder)
{
    char command[128];
    snprintf(command, sizeof command, "rm -r %s", folder);
    return system(command);
}

static const char *path_of(const char *name)
{
    static char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return path;
}

static bool exists(const char *path)
{
    struct stat entry;
    return stat(path, &entry) == 0;
}

static void assert_clean(const Error *err)
{
    if (!error_is_clean(err)) fail_msg("%s", err->message);
}

// A value that no two places share and that a float holds exactly.
static double value_at(int64_t row, int32_t column)
{
    return (double)(row % 60000) * 128.0 + column + 0.5;
}

static ArrayFile *create_with_series(const char *path)
{
    Error err = {0};
    ArrayFile *file = array_file_create(path, &err);
    assert_clean(&err);
    ArraySeries wide = {"interface/slip", ARRAY_FLOAT32, WIDTH, "length", "u_x since the start"};
    ArraySeries thin = {"series/time", ARRAY_FLOAT64, 1, "time", "t"};
    array_file_add_series(file, &wide, &err);
    array_file_add_series(file, &thin, &err);
    assert_clean(&err);
    return file;
}

// Rows [first, last) of both series, one at a time.
static bool append_rows(ArrayFile *file, int64_t first, int64_t last, Error *err)
{
    for (int64_t row = first; row < last; row++) {
        double values[WIDTH];
        for (int32_t k = 0; k < WIDTH; k++) values[k] = value_at(row, k);
        double time = 1e-3 * (double)row;
        if (!array_file_append(file, "interface/slip", values, 1, err)) return false;
        if (!array_file_append(file, "series/time", &time, 1, err)) return false;
    }
    return true;
}

static void assert_holds_rows(ArrayFile *file, int64_t expected)
{
    Error err = {0};
    double *values = NULL;
    int64_t rows = 0;
    int32_t width = 0;
    array_file_read(file, "interface/slip", &values, &rows, &width, &err);
    assert_clean(&err);
    assert_int_equal(rows, expected);
    assert_int_equal(width, WIDTH);
    for (int64_t row = 0; row < rows; row++)
        for (int32_t k = 0; k < WIDTH; k++)
            if (values[row * WIDTH + k] != value_at(row, k))
                fail_msg("row %lld column %d holds %g", (long long)row, k, values[row * WIDTH + k]);
    memory_free(values);
    array_file_read(file, "series/time", &values, &rows, &width, &err);
    assert_clean(&err);
    assert_int_equal(rows, expected);
    assert_int_equal(width, 1);
    for (int64_t row = 0; row < rows; row++) assert_true(values[row] == 1e-3 * (double)row);
    memory_free(values);
}

TEST(rows_come_back)
{
    const char *path = path_of("rows.h5");
    // Around a chunk's end, across many chunks, and with flushes in between.
    static const int64_t counts[] = {0, 1, 201, 202, 203, 2500};
    for (size_t c = 0; c < sizeof counts / sizeof counts[0]; c++) {
        Error err = {0};
        ArrayFile *file = create_with_series(path);
        for (int64_t row = 0; row < counts[c]; row += 500) {
            int64_t last = row + 500 < counts[c] ? row + 500 : counts[c];
            append_rows(file, row, last, &err);
            if (row % 1000 == 0) array_file_flush(file, &err);
        }
        assert_clean(&err);
        assert_holds_rows(file, counts[c]);   // while it is still being written
        assert_true(array_file_close(file, &err));
        file = array_file_open(path, &err);
        assert_clean(&err);
        assert_holds_rows(file, counts[c]);
        assert_true(array_file_close(file, &err));
    }
    char part[PATH_SIZE + 8];
    snprintf(part, sizeof part, "%s.part", path);
    assert_false(exists(part));
}

TEST(a_block_of_rows_is_the_same_as_single_ones)
{
    Error err = {0};
    enum { ROWS = 2000 };
    const char *path = path_of("block.h5");
    double *values = NEW_ARRAY(double, ROWS *WIDTH, &err);
    double *times = NEW_ARRAY(double, ROWS, &err);
    assert_clean(&err);
    for (int64_t row = 0; row < ROWS; row++) {
        times[row] = 1e-3 * (double)row;
        for (int32_t k = 0; k < WIDTH; k++) values[row * WIDTH + k] = value_at(row, k);
    }
    ArrayFile *file = create_with_series(path);
    append_rows(file, 0, 10, &err);
    array_file_append(file, "interface/slip", values + 10 * WIDTH, ROWS - 10, &err);
    array_file_append(file, "series/time", times + 10, ROWS - 10, &err);
    assert_clean(&err);
    assert_holds_rows(file, ROWS);
    assert_true(array_file_close(file, &err));
    memory_free(values);
    memory_free(times);
}

// Whole arrays, and members of structs that stand side by side.
TEST(a_series_is_written_at_once)
{
    Error err = {0};
    double packed[3][4] = {{1, 2, 3, 4}, {5, 6, 7, 8}, {9, 10, 11, 12}}, *found = NULL;
    const ArraySeries whole = {"whole", ARRAY_FLOAT64, 4, "1", "all"};
    const ArraySeries part = {"part", ARRAY_FLOAT64, 2, "1", "the middle of each"};
    ArrayFile *file = array_file_create(path_of("once.h5"), &err);
    assert_clean(&err);
    assert_true(array_file_write(file, &whole, packed[0], 0, 3, &err));
    assert_true(array_file_write(file, &part, &packed[0][1], 4, 3, &err));
    assert_true(array_file_close(file, &err));
    file = array_file_open(path_of("once.h5"), &err);
    assert_clean(&err);
    for (int32_t columns = 4; columns > 0; columns -= 2) {
        int64_t rows = 0;
        int32_t width = 0;
        array_file_read(file, columns == 4 ? "whole" : "part", &found, &rows, &width, &err);
        assert_clean(&err);
        assert_int_equal(rows, 3);
        assert_int_equal(width, columns);
        for (int32_t k = 0; k < 3 * columns; k++)
            assert_true(found[k] == packed[k / columns][k % columns + (columns == 2)]);
        memory_free(found);
    }
    array_file_close(file, &err);
    unlink(path_of("once.h5"));
}

// The file as a reader with nothing but HDF5 sees it: types, shapes, chunks, filters, attributes.
TEST(the_stored_form_is_as_stated)
{
    Error err = {0};
    const char *path = path_of("form.h5");
    ArrayFile *file = create_with_series(path);
    append_rows(file, 0, 3, &err);
    array_file_set_text(file, "title", "Figure 1, \xC2\xB5(U)", &err);
    array_file_set_number(file, "length", 1.0, &err);
    array_file_set_number(file, "length", 0.1, &err);   // the last one counts
    assert_true(array_file_close(file, &err));

    hid_t id = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
    hid_t dataset = H5Dopen2(id, "interface/slip", H5P_DEFAULT);
    hid_t type = H5Dget_type(dataset), space = H5Dget_space(dataset);
    hid_t creation = H5Dget_create_plist(dataset);
    assert_true(H5Tequal(type, H5T_IEEE_F32LE) > 0);
    hsize_t shape[2], shape_max[2], chunk[2];
    assert_int_equal(H5Sget_simple_extent_dims(space, shape, shape_max), 2);
    assert_int_equal(shape[0], 3);
    assert_int_equal(shape[1], WIDTH);
    assert_true(shape_max[0] == H5S_UNLIMITED);
    assert_int_equal(H5Pget_chunk(creation, 2, chunk), 2);
    assert_in_range(chunk[0] * chunk[1] * 4, 32 * 1024, 1024 * 1024);
    assert_int_equal(H5Pget_nfilters(creation), 2);
    unsigned level = 0;
    size_t level_count = 1;
    assert_true(
        H5Pget_filter_by_id2(creation, H5Z_FILTER_SHUFFLE, NULL, NULL, NULL, 0, NULL, NULL) >= 0);
    assert_true(H5Pget_filter_by_id2(creation, H5Z_FILTER_DEFLATE, NULL, &level_count, &level, 0,
                                     NULL, NULL) >= 0);
    assert_int_equal(level, 2);
    hid_t attribute = H5Aopen(dataset, "unit", H5P_DEFAULT);
    hid_t text = H5Aget_type(attribute);
    char *unit = NULL;
    assert_true(H5Tis_variable_str(text) > 0 && H5Tget_cset(text) == H5T_CSET_UTF8);
    assert_true(H5Aread(attribute, text, &unit) >= 0);
    assert_string_equal(unit, "length");
    H5free_memory(unit);
    H5Tclose(text), H5Aclose(attribute), H5Pclose(creation), H5Sclose(space), H5Tclose(type);
    H5Dclose(dataset), H5Fclose(id);

    file = array_file_open(path, &err);
    char title[64], cut[8];
    double number = 0;
    assert_true(array_file_get_text(file, "title", title, sizeof title, &err));
    assert_string_equal(title, "Figure 1, \xC2\xB5(U)");
    assert_true(array_file_get_text(file, "title", cut, sizeof cut, &err));
    assert_string_equal(cut, "Figure ");
    assert_true(array_file_get_number(file, "length", &number, &err));
    assert_true(number == 0.1);
    assert_true(array_file_has(file, "interface") && array_file_has(file, "series/time"));
    assert_false(array_file_has(file, "series/other") || array_file_has(file, "other/time") ||
                 array_file_has(file, ""));
    assert_true(array_file_close(file, &err));
}

TEST(integers_round_and_saturate)
{
    Error err = {0};
    ArrayFile *file = array_file_create(path_of("integers.h5"), &err);
    ArraySeries small = {"small", ARRAY_UINT8, 1, "1", ""};
    ArraySeries large = {"large", ARRAY_INT32, 1, "1", ""};
    array_file_add_series(file, &small, &err);
    array_file_add_series(file, &large, &err);
    const double given[] = {0, 1.4, 1.6, 255, 256, -3, NAN, INFINITY, 3e9, -3e9};
    const double as_uint8[] = {0, 1, 2, 255, 255, 0, 0, 255, 255, 0};
    const double as_int32[] = {0, 1, 2, 255, 256, -3, 0, 2147483647, 2147483647, -2147483648.0};
    array_file_append(file, "small", given, 10, &err);
    array_file_append(file, "large", given, 10, &err);
    double *values = NULL;
    int64_t rows;
    int32_t width;
    assert_true(array_file_read(file, "small", &values, &rows, &width, &err));
    assert_memory_equal(values, as_uint8, sizeof as_uint8);
    memory_free(values);
    assert_true(array_file_read(file, "large", &values, &rows, &width, &err));
    assert_memory_equal(values, as_int32, sizeof as_int32);
    memory_free(values);
    assert_true(array_file_close(file, &err));
}

TEST(appending_allocates_no_arrays)
{
    Error err = {0};
    ArrayFile *file = create_with_series(path_of("allocations.h5"));
    int64_t before = memory_counters().allocations;
    append_rows(file, 0, 3000, &err);
    array_file_flush(file, &err);
    assert_int_equal(memory_counters().allocations, before);
    assert_true(array_file_close(file, &err));
}

// The child appends, flushes at row `flushed`, appends on to `last`, and is killed there.
static void write_until_killed(const char *path, int64_t flushed, int64_t last)
{
    pid_t child = fork();
    if (child == 0) {
        Error err = {0};
        ArrayFile *file = create_with_series(path);
        append_rows(file, 0, flushed, &err);
        array_file_flush(file, &err);
        append_rows(file, flushed, last, &err);
        raise(SIGKILL);
    }
    int status = 0;
    waitpid(child, &status, 0);
    assert_true(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
}

TEST(a_killed_run_keeps_what_was_flushed)
{
    static const int64_t flushed[] = {0, 5, 202, 1000};
    for (size_t c = 0; c < 4; c++)
        for (int64_t more = 0; more < 100000; more = 10 * more + 900) {
            Error err = {0};
            const char *path = path_of("killed.h5");
            write_until_killed(path, flushed[c], flushed[c] + more);
            assert_false(exists(path));
            ArrayFile *file = array_file_open(path, &err);   // finds the .part
            assert_clean(&err);
            assert_holds_rows(file, flushed[c]);
            assert_true(array_file_close(file, &err));
        }
}

// With a limit on the size of files: as on a full disk, writes fail from some point on.
static void fill_disk_in_child(const char *path, rlim_t limit, int64_t flush_every)
{
    pid_t child = fork();
    if (child == 0) {
        Error err = {0}, closing = {0};
        signal(SIGXFSZ, SIG_IGN);
        setrlimit(RLIMIT_FSIZE, &(struct rlimit){limit, RLIM_INFINITY});
        ArrayFile *file = array_file_create(path, &err);
        ArraySeries wide = {"noise", ARRAY_FLOAT64, WIDTH, "1", "incompressible"};
        if (file) array_file_add_series(file, &wide, &err);
        uint64_t bits = 1;
        for (int64_t row = 0; row < 20000 && error_is_clean(&err); row++) {
            double values[WIDTH];
            for (int32_t k = 0; k < WIDTH; k++) {
                bits = bits * 6364136223846793005u + 1442695040888963407u;
                values[k] = (double)bits;
            }
            array_file_append(file, "noise", values, 1, &err);
            if (row % flush_every == flush_every - 1) array_file_flush(file, &err);
        }
        bool refused = !file || !array_file_close(file, &closing);
        if (error_is_clean(&err)) err = closing;
        bool named = err.code == ERROR_FILE && strstr(err.message, path) &&
                     strstr(err.message, "File too large");
        if (!refused || !named) fprintf(stderr, "%s\n", err.message);
        // Coverage counts are files, too, and are written on exit.
        setrlimit(RLIMIT_FSIZE, &(struct rlimit){RLIM_INFINITY, RLIM_INFINITY});
        exit(refused && named ? 0 : 1);   // runs HDF5's own exit handler
    }
    int status = 0;
    waitpid(child, &status, 0);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
}

TEST(a_full_disk_is_an_error_and_no_crash)
{
    static const rlim_t limits[] = {0, 100, 1000, 2000, 20000, 300000, 1000000, 1234567};
    const char *path = path_of("full.h5");
    for (size_t c = 0; c < sizeof limits / sizeof limits[0]; c++) {
        fill_disk_in_child(path, limits[c], 100);
        fill_disk_in_child(path, limits[c], 20001);
        assert_false(exists(path));
    }
    // Parts fit (13 MB in all), what they are joined into does not.
    fill_disk_in_child(path, 10000000, 5000);
    assert_false(exists(path));
    // Rows that were flushed before the disk was full can still be read.
    Error err = {0};
    double *values = NULL;
    int64_t rows = 0;
    int32_t width = 0;
    fill_disk_in_child(path, 1000000, 100);
    ArrayFile *file = array_file_open(path, &err);
    assert_clean(&err);
    assert_true(array_file_read(file, "noise", &values, &rows, &width, &err));
    assert_true(rows >= 100 && rows % 100 == 0 && width == WIDTH);
    memory_free(values);
    assert_true(array_file_close(file, &err));
}

static void assert_error(Error *err, ErrorCode code, const char *part, const char *other)
{
    if (err->code != code || !strstr(err->message, part) || !strstr(err->message, other))
        fail_msg("not the error expected (%s, %s): %s", part, other, err->message);
    error_clear(err);
}

TEST(bad_use_is_named)
{
    Error err = {0};
    assert_null(array_file_create("/proc/none/a.h5", &err));
    assert_error(&err, ERROR_FILE, "/proc/none/a.h5", "No such file or directory");
    assert_null(array_file_open("/proc/none/a.h5", &err));
    assert_error(&err, ERROR_FILE, "/proc/none/a.h5", "No such file or directory");
    assert_null(array_file_create("", &err));
    assert_error(&err, ERROR_FILE, "empty or too long", "");

    FILE *text = fopen(path_of("text.h5"), "w");
    fputs("no HDF5 at all\n", text);
    fclose(text);
    assert_null(array_file_open(path_of("text.h5"), &err));
    assert_error(&err, ERROR_FILE, "text.h5", "not a whole HDF5 file");

    ArrayFile *file = create_with_series(path_of("use.h5"));
    double value = 1, *values = NULL;
    int64_t rows;
    int32_t width;
    assert_false(array_file_append(file, "series/other", &value, 1, &err));
    assert_error(&err, ERROR_LIBRARY, "use.h5", "series/other");
    ArraySeries again = {"series/time", ARRAY_FLOAT64, 1, "time", "t"};
    assert_false(array_file_add_series(file, &again, &err));
    assert_error(&err, ERROR_LIBRARY, "series/time", "already");
    assert_false(array_file_read(file, "series/other", &values, &rows, &width, &err));
    assert_null(values);
    assert_error(&err, ERROR_FILE, "use.h5", "series/other");
    assert_false(array_file_read(file, "series", &values, &rows, &width, &err));
    assert_error(&err, ERROR_FILE, "series", "no array");
    assert_false(array_file_get_number(file, "other", &value, &err));
    assert_error(&err, ERROR_FILE, "use.h5", "other");
    array_file_set_text(file, "title", "t", &err);
    assert_false(array_file_get_number(file, "title", &value, &err));
    assert_error(&err, ERROR_FILE, "title", "no number");
    assert_null(array_file_create(path_of("use.h5"), &err));   // it is being written
    assert_error(&err, ERROR_FILE, "use.h5", "another process");
    assert_true(array_file_close(file, &err));
    assert_true(array_file_close(NULL, &err));
}

// Files that HDF5 reads and we did not write.
TEST(what_others_wrote_is_checked)
{
    Error err = {0};
    const char *path = path_of("foreign.h5");
    hid_t id = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    hid_t cube = H5Screate_simple(4, (hsize_t[]){2, 2, 2, 2}, NULL);
    hid_t plane = H5Screate_simple(2, (hsize_t[]){2, 3}, NULL);
    hid_t wide = H5Screate_simple(2, (hsize_t[]){1, (hsize_t)1 << 40}, NULL);
    hid_t text = H5Tcopy(H5T_C_S1);
    const int64_t whole[6] = {1, 2, 3, 4, 5, -6};
    H5Dclose(H5Dcreate2(id, "cube", H5T_NATIVE_INT, cube, 0, 0, 0));
    H5Dclose(H5Dcreate2(id, "wide", H5T_NATIVE_INT8, wide, 0, 0, 0));
    H5Dclose(H5Dcreate2(id, "texts", text, plane, 0, 0, 0));
    hid_t integers = H5Dcreate2(id, "integers", H5T_STD_I64BE, plane, 0, 0, 0);
    H5Dwrite(integers, H5T_NATIVE_INT64, H5S_ALL, H5S_ALL, 0, whole);
    H5Aclose(H5Acreate2(id, "list", H5T_NATIVE_INT, plane, 0, 0));
    enum { UNITS = 500 };   // their pointers are more than the stack of a reader of one text has
    const char *units[UNITS];
    for (int32_t k = 0; k < UNITS; k++) units[k] = "si";
    hid_t many = H5Screate_simple(1, (hsize_t[]){UNITS}, NULL), nothing = H5Screate(H5S_NULL);
    hid_t texts = H5Tcopy(H5T_C_S1);
    H5Tset_size(texts, H5T_VARIABLE);
    hid_t attribute = H5Acreate2(id, "units", texts, many, 0, 0);
    assert_true(H5Awrite(attribute, texts, units) >= 0);
    H5Aclose(attribute), H5Aclose(H5Acreate2(id, "nothing", texts, nothing, 0, 0));
    H5Tclose(texts), H5Sclose(many), H5Sclose(nothing);
    H5Dclose(integers), H5Tclose(text), H5Sclose(wide), H5Sclose(plane), H5Sclose(cube);
    H5Fclose(id);

    ArrayFile *file = array_file_open(path, &err);
    double *values = NULL, number;
    int64_t rows;
    int32_t width;
    char title[8];
    assert_true(array_file_read(file, "integers", &values, &rows, &width, &err));
    assert_true(rows == 2 && width == 3);
    for (int32_t k = 0; k < 6; k++) assert_true(values[k] == (double)whole[k]);
    memory_free(values);
    assert_false(array_file_read(file, "cube", &values, &rows, &width, &err));
    assert_error(&err, ERROR_FILE, "cube", "4 dimensions");
    assert_false(array_file_read(file, "wide", &values, &rows, &width, &err));
    assert_error(&err, ERROR_FILE, "wide", "too large");
    assert_false(array_file_read(file, "texts", &values, &rows, &width, &err));
    assert_error(&err, ERROR_FILE, "texts", "cannot read");
    assert_false(array_file_get_number(file, "list", &number, &err));
    assert_error(&err, ERROR_FILE, "list", "no number");
    assert_false(array_file_get_text(file, "list", title, sizeof title, &err));
    assert_error(&err, ERROR_FILE, "list", "no text");
    assert_false(array_file_get_text(file, "units", title, sizeof title, &err));
    assert_error(&err, ERROR_FILE, "units", "no text");
    assert_false(array_file_get_text(file, "nothing", title, sizeof title, &err));
    assert_error(&err, ERROR_FILE, "nothing", "no text");
    assert_false(array_file_set_number(file, "length", 1, &err));
    assert_error(&err, ERROR_LIBRARY, "foreign.h5", "reading only");
    assert_true(array_file_close(file, &err));
}

// Whoever reads such a file would read, or write, another one, or wait for a pipe.
TEST(what_leads_to_other_files_is_refused)
{
    enum { EXTERNAL, VIRTUAL, VIRTUAL_UNLIMITED, LINK_OUT, LINK_BY_NAME, TYPE, KINDS };
    static const char *const words[KINDS] = {"another file", "another file", "another file",
                                             "link by name", "link by name", "neither"};
    char pipe[PATH_SIZE], path[PATH_SIZE];
    snprintf(path, sizeof path, "%s", path_of("leads.h5"));
    snprintf(pipe, sizeof pipe, "%s", path_of("pipe"));
    assert_int_equal(mkfifo(pipe, 0600), 0);
    for (int32_t kind = 0; kind < KINDS; kind++) {
        Error err = {0};
        hsize_t size[] = {4}, endless[] = {H5S_UNLIMITED}, one[] = {1}, start[] = {0};
        hid_t id = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
        hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
        hid_t space = H5Screate_simple(1, size, kind == VIRTUAL_UNLIMITED ? endless : NULL);
        hid_t from = H5Screate_simple(1, size, kind == VIRTUAL_UNLIMITED ? endless : NULL);
        H5Gclose(H5Gcreate2(id, "series", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
        if (kind == EXTERNAL) H5Pset_external(creation, pipe, 0, 32);
        if (kind == VIRTUAL) H5Pset_virtual(creation, space, pipe, "x", from);
        if (kind == VIRTUAL_UNLIMITED) {
            H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, one, endless);
            H5Sselect_hyperslab(from, H5S_SELECT_SET, start, NULL, one, endless);
            assert_true(H5Pset_virtual(creation, space, pipe, "x", from) >= 0);
        }
        if (kind <= VIRTUAL_UNLIMITED) {
            hid_t made = H5Dcreate2(id, "series/time", H5T_NATIVE_DOUBLE, space, 0, creation, 0);
            assert_true(made >= 0);
            H5Dclose(made);
        }
        if (kind == LINK_OUT) H5Lcreate_external(pipe, "/x", id, "series/time", 0, 0);
        if (kind == LINK_BY_NAME) H5Lcreate_soft("/series", id, "series/time", 0, 0);
        hid_t type = H5Tcopy(H5T_NATIVE_INT);
        if (kind == TYPE) H5Tcommit2(id, "series/time", type, 0, 0, 0);
        H5Tclose(type), H5Sclose(from), H5Sclose(space), H5Pclose(creation), H5Fclose(id);
        alarm(20);
        assert_null(array_file_open(path, &err));
        assert_error(&err, ERROR_FILE, "series/time", words[kind]);
        assert_null(array_file_reopen(path, &err));
        assert_error(&err, ERROR_FILE, "series/time", words[kind]);
        alarm(0);
        unlink(path_of("leads.h5.part"));
    }
    Error err = {0};
    alarm(20);
    assert_null(array_file_open(pipe, &err));   // and itself
    assert_error(&err, ERROR_INPUT, "pipe", "not a file");
    alarm(0);
    unlink(pipe);
}

// A copy of a good file, cut at every 997th byte: an error or the right rows, and no crash.
TEST(a_cut_file_is_an_error)
{
    Error err = {0};
    static char bytes[100000];
    ArrayFile *file = create_with_series(path_of("whole.h5"));
    append_rows(file, 0, 300, &err);
    assert_true(array_file_close(file, &err));
    FILE *from = fopen(path_of("whole.h5"), "rb");
    size_t length = fread(bytes, 1, sizeof bytes, from);
    fclose(from);
    assert_in_range(length, 10000, sizeof bytes - 1);
    for (size_t cut = 0; cut < length; cut += 997) {
        FILE *to = fopen(path_of("cut.h5"), "wb");
        fwrite(bytes, 1, cut, to);
        fclose(to);
        file = array_file_open(path_of("cut.h5"), &err);
        assert_null(file);
        assert_error(&err, ERROR_FILE, "cut.h5", cut ? "not a whole HDF5 file" : "is empty");
    }
}

TEST(every_path_frees_when_memory_is_short)
{
    int64_t live = memory_counters().live;
    int32_t failures = 0;
    for (int64_t k = 0; k < 40; k++) {
        Error err = {0}, closing = {0};
        double *values = NULL;
        int64_t rows;
        int32_t width;
        memory_fail_after(k);
        ArrayFile *file = array_file_create(path_of("short.h5"), &err);
        for (int32_t s = 0; file && s < 20; s++) {   // more than the first list of series holds
            char name[24];
            snprintf(name, sizeof name, "series%d", s);
            ArraySeries series = {name, ARRAY_UINT8, 3, "1", ""};
            if (error_is_clean(&err)) array_file_add_series(file, &series, &err);
        }
        if (error_is_clean(&err)) array_file_read(file, "series3", &values, &rows, &width, &err);
        memory_fail_after(-1);
        memory_free(values);
        array_file_close(file, &closing);
        failures += err.code == ERROR_MEMORY;
        assert_true(error_is_clean(&err) || err.code == ERROR_MEMORY);
        assert_int_equal(memory_counters().live, live);
        memory_fail_after(k);
        file = array_file_open(path_of("form.h5"), &closing);
        memory_fail_after(-1);
        assert_true(file || closing.code == ERROR_MEMORY);
        array_file_close(file, &closing);
        assert_int_equal(memory_counters().live, live);
    }
    assert_in_range(failures, 20, 40);
}

// The module is looked for with every file; where it is missing no file is begun.
TEST(a_missing_module_is_named)
{
    Error err = {0};
    int64_t live = memory_counters().live;
    char modules[PATH_SIZE], part[PATH_SIZE];
    snprintf(modules, sizeof modules, "%s", getenv("AMONTONS_MODULES"));
    snprintf(part, sizeof part, "%s/alone.h5.part", folder);
    setenv("AMONTONS_MODULES", folder, 1);
    assert_null(array_file_create(path_of("alone.h5"), &err));
    assert_error(&err, ERROR_LIBRARY, folder, "amontons_hdf5.so");
    assert_false(exists(part));
    assert_null(array_file_open(path_of("whole.h5"), &err));
    assert_error(&err, ERROR_LIBRARY, folder, "amontons_hdf5.so");
    assert_int_equal(memory_counters().live, live);
    setenv("AMONTONS_MODULES", modules, 1);
}

GROUP_BETWEEN(make_folder, remove_folder);
