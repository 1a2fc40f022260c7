// SPDX-License-Identifier: GPL-2.0-or-later
// Writes one mesh of every kind of cell, interface lines and a collection, and all that can go
// wrong with them. What the files hold is read by VTK's own reader and by meshio in
// tests/end_to_end/test_field_files.py, which finds them in AMONTONS_TEST_OUTPUT and knows the same
// formulas.
#include "io/fields/field_file.h"

#include "cases.h"
#include "io/files/own_list.h"

#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

enum { POINTS = 25, CELLS = 5, LINES = 4 };

// Quad, 8-node quad, 9-node quad, triangle, 6-node triangle, over shared points.
static uint8_t cell_types[CELLS] = {9, 23, 28, 5, 22};
static int64_t offsets[CELLS + 1] = {0, 4, 12, 21, 24, 30};
static int64_t connectivity[30] = {0,  1,  6,  5,  1,  3,  13, 11, 2, 8,  12, 6,  10, 12, 22,
                                   20, 11, 17, 21, 15, 16, 3,  4,  9, 12, 14, 24, 13, 19, 18};
static int64_t line_offsets[LINES + 1] = {0, 2, 4, 6, 8};
static int64_t line_nodes[2 * LINES] = {0, 1, 1, 2, 2, 3, 3, 4};

static char folder[256];
static char path[300], part[308];
static double points[3 * POINTS], vectors[3 * POINTS], scalars[POINTS];

// The formulas that the Python test knows: doubles that need all their digits.
static void fill_values(void)
{
    for (int32_t k = 0; k < POINTS; k++) {
        points[3 * k] = 0.1 * (k % 5);
        points[3 * k + 1] = 0.1 * (k / 5);
        for (int32_t c = 0; c < 3; c++) vectors[3 * k + c] = (k + 1) / 3.0 + c;
        scalars[k] = 1.0 / (k + 7);
    }
}

FIXTURE(make_folder)
{
    fill_values();
    const char *given = getenv("AMONTONS_TEST_OUTPUT");
    snprintf(folder, sizeof folder, "%s", given ? given : "/tmp/amontons_field_XXXXXX");
    return (given || mkdtemp(folder)) && own_list_make(folder, &(Error){0}) ? 0 : -1;
}

FIXTURE(remove_folder)
{
    char command[300];
    if (getenv("AMONTONS_TEST_OUTPUT")) return 0;
    snprintf(command, sizeof command, "rm -r %s", folder);
    return system(command);
}

static const FieldArray point_arrays[] = {
    {"displacement", 3, vectors},
    {"von_mises", 1, scalars},
};

static FieldGrid bulk_grid(void)
{
    return (FieldGrid){.point_count = POINTS,
                       .points = points,
                       .cell_count = CELLS,
                       .offsets = offsets,
                       .connectivity = connectivity,
                       .cell_types = cell_types,
                       .time = 1.0 / 3.0,
                       .point_array_count = 2,
                       .point_arrays = point_arrays};
}

static FieldGrid line_grid(void)
{
    return (FieldGrid){.point_count = 5,
                       .points = points,
                       .cell_count = LINES,
                       .offsets = line_offsets,
                       .connectivity = line_nodes,
                       .time = 1e-7,
                       .point_array_count = 2,
                       .point_arrays = point_arrays};
}

static void name_file(const char *name)
{
    snprintf(path, sizeof path, "%s/%s", folder, name);
    snprintf(part, sizeof part, "%s.part", path);
}

static bool exists(const char *name)
{
    struct stat entry;
    return stat(name, &entry) == 0;
}

static void assert_file_has(const char *words)
{
    char text[8192] = {0};
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    size_t length = fread(text, 1, sizeof text - 1, file);
    fclose(file);
    for (size_t k = 0; k < length; k++)
        if (text[k] == '\0') text[k] = ' ';   // the appended data
    if (!strstr(text, words)) fail_msg("%s lacks %s", path, words);
}

TEST(grids_are_appended_compressed_and_wide)
{
    Error err = {0};
    FieldGrid bulk = bulk_grid(), lines = line_grid();
    name_file("bulk.vtu");
    if (!field_file_write(path, &bulk, &err)) fail_msg("%s", err.message);
    assert_false(exists(part));
    assert_file_has("type=\"UnstructuredGrid\"");
    assert_file_has("header_type=\"UInt64\"");
    assert_file_has("compressor=\"vtkZLibDataCompressor\"");
    assert_file_has("<AppendedData encoding=\"raw\">");
    assert_file_has("Name=\"TimeValue\"");
    name_file("interface.vtp");
    if (!field_file_write(path, &lines, &err)) fail_msg("%s", err.message);
    assert_file_has("type=\"PolyData\"");
    assert_file_has("NumberOfLines=\"4\"");
    assert_false(exists(part));
}

TEST(the_collection_lists_files_against_time)
{
    Error err = {0};
    const double times[] = {0, 1.0 / 3.0};
    name_file("fields.pvd");
    assert_true(field_file_write_pvd(path, NULL, 0, &err));
    assert_file_has("  <Collection>\n  </Collection>\n</VTKFile>\n");
    assert_true(field_file_write_pvd(path, times, 2, &err));
    assert_file_has("<DataSet timestep=\"0.33333333333333331\" part=\"0\" name=\"bulk\" "
                    "file=\"fields/bulk_000001.vtu\"/>");
    assert_file_has("<DataSet timestep=\"0.33333333333333331\" part=\"1\" name=\"interface\" "
                    "file=\"fields/interface_000001.vtp\"/>");
    assert_false(exists(part));
}

static void assert_error(Error *err, ErrorCode code, const char *words, const char *other)
{
    if (err->code != code || !strstr(err->message, words) || !strstr(err->message, other))
        fail_msg("not the error expected (%s, %s): %s", words, other, err->message);
    error_clear(err);
}

TEST(a_missing_folder_is_named)
{
    Error err = {0};
    FieldGrid bulk = bulk_grid(), lines = line_grid();
    assert_false(field_file_write("/proc/none/a.vtu", &bulk, &err));
    assert_error(&err, ERROR_FILE, "/proc/none/a.vtu", "No such file or directory");
    assert_false(field_file_write("/proc/none/a.vtp", &lines, &err));
    assert_error(&err, ERROR_FILE, "/proc/none/a.vtp", "No such file or directory");
    assert_false(field_file_write_pvd("/proc/none/a.pvd", NULL, 0, &err));
    assert_error(&err, ERROR_FILE, "/proc/none/a.pvd", "No such file or directory");
    assert_false(field_file_write_pvd("/proc/a.pvd", NULL, 0, &err));
    assert_error(&err, ERROR_FILE, "/proc/a.pvd", "");
}

// A limit on the size of files stands in for a full disk.
TEST(a_full_disk_leaves_the_earlier_file)
{
    Error err = {0};
    FieldGrid bulk = bulk_grid();
    name_file("full.vtu");
    assert_true(field_file_write(path, &bulk, &err));
    struct stat before, after;
    assert_int_equal(stat(path, &before), 0);
    for (rlim_t limit = 0; limit < 3000; limit += 1000) {
        pid_t child = fork();
        if (child == 0) {
            signal(SIGXFSZ, SIG_IGN);
            setrlimit(RLIMIT_FSIZE, &(struct rlimit){limit, RLIM_INFINITY});
            bool refused = !field_file_write(path, &bulk, &err) && err.code == ERROR_FILE &&
                           strstr(err.message, path) && strstr(err.message, "File too large");
            // Coverage counts are files, too, and are written on exit.
            setrlimit(RLIMIT_FSIZE, &(struct rlimit){RLIM_INFINITY, RLIM_INFINITY});
            exit(refused && !exists(part) ? 0 : 1);
        }
        int status = 0;
        waitpid(child, &status, 0);
        assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    }
    assert_int_equal(stat(path, &after), 0);
    assert_int_equal(before.st_ino, after.st_ino);
    assert_int_equal(before.st_size, after.st_size);
}

TEST(a_missing_module_is_named)
{
    Error err = {0};
    FieldGrid bulk = bulk_grid();
    name_file("module.vtu");
    const char *modules = getenv("AMONTONS_MODULES");
    char *kept = strdup(modules ? modules : "");
    setenv("AMONTONS_MODULES", "/proc/none", 1);
    assert_false(field_file_write(path, &bulk, &err));
    assert_error(&err, ERROR_LIBRARY, "module.vtu", "amontons_vtk");
    setenv("AMONTONS_MODULES", kept, 1);
    free(kept);
    assert_false(exists(path) || exists(part));
}

GROUP_BETWEEN(make_folder, remove_folder);
