// SPDX-License-Identifier: GPL-2.0-or-later
// The scanner for DefineConstant, on text that tries to mislead it, and on the shipped meshes,
// where gmsh itself says whether a name is taken.
#include "io/mesh/geo_parameters.h"

#include "base/memory.h"
#include "cases.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { PATH_SIZE = 400 };

static char folder[100];

static const char *write_file(const char *name, const char *text, char path[PATH_SIZE])
{
    snprintf(path, PATH_SIZE, "%s/%s", folder, name);
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
    return path;
}

FIXTURE(make_folder)
{
    snprintf(folder, sizeof folder, "/tmp/amontons_geo_XXXXXX");
    return mkdtemp(folder) ? 0 : -1;
}

FIXTURE(remove_folder)
{
    char command[200];
    snprintf(command, sizeof command, "rm -r '%s'", folder);
    return system(command);
}

static void expect(const char *text, int32_t count, const char *const *names, const bool *texts)
{
    char path[PATH_SIZE];
    Error err = {0};
    GeoParameters known;
    if (!geo_parameters_read(write_file("a.geo", text, path), &known, &err))
        fail_msg("%s", err.message);
    assert_int_equal(known.count, count);
    for (int32_t k = 0; k < count; k++) {
        assert_string_equal(known.items[k].name, names[k]);
        assert_int_equal(known.items[k].is_text, texts[k]);
    }
    geo_parameters_destroy(&known);
}

TEST(test_lists)
{
    static const char *const names[] = {"nx", "shape", "order", "file", "bare", "last"};
    static const bool texts[] = {false, true, false, true, false, false};
    expect("DefineConstant[ nx = 3 * Sqrt(4), shape = \"a, b] = c\" ];\n"
           "DefineConstant [ order = {1, Choices{1 = \"one\", 2}, Name \"Mesh/order\"},\n"
           "  file = {\"x\", Kind \"file\"}, bare ];\n"
           "nothing = 4; y = x[3]; DefineConstants = 1;\n"
           "DefineConstant[last = Max(1, 2) + other];",
           6, names, texts);
}

TEST(test_comments)
{
    static const char *const names[] = {"a", "b"};
    static const bool texts[] = {false, true};
    expect("// DefineConstant[ no = 1 ];\n/* DefineConstant[ no = 1 ]; */\n"
           "Printf(\"DefineConstant[ no = 1 ]\");\n"
           "DefineConstant[ a = 1, // , no = 2\n /* no = 3, */ b = /* x */ \"t\" ];\n",
           2, names, texts);
}

// Ends of file in the midst of things: no harm, gmsh will complain.
TEST(test_unfinished)
{
    static const char *const texts[] = {"DefineConstant",
                                        "DefineConstant[",
                                        "DefineConstant[ a",
                                        "DefineConstant[ a = \"",
                                        "DefineConstant[ a ",
                                        "DefineConstant = 3;",
                                        "DefineConstant( a = {1, 2}",
                                        "/* DefineConstant",
                                        "\"",
                                        "Include"};
    char path[PATH_SIZE];
    for (size_t k = 0; k < sizeof texts / sizeof *texts; k++) {
        Error err = {0};
        GeoParameters known;
        assert_true(geo_parameters_read(write_file("a.geo", texts[k], path), &known, &err));
        geo_parameters_destroy(&known);
    }
}

TEST(test_includes)
{
    char path[PATH_SIZE];
    Error err = {0};
    GeoParameters known;
    write_file("inner.geo", "DefineConstant[ deep = 1 ];\n", path);
    write_file("outer.geo", "Include \"inner.geo\";\nDefineConstant[ shallow = 1 ];\n", path);
    assert_true(geo_parameters_read(path, &known, &err));
    assert_int_equal(known.count, 2);
    assert_string_equal(known.items[0].name, "deep");
    geo_parameters_destroy(&known);

    write_file("lost.geo", "Include \"absent.geo\";\n", path);
    assert_false(geo_parameters_read(path, &known, &err));
    geo_parameters_destroy(&known);
    assert_int_equal(err.code, ERROR_INPUT);
    assert_non_null(strstr(err.message, "absent.geo: No such file"));
    assert_non_null(strstr(err.message, "lost.geo"));

    error_clear(&err);
    write_file("ring.geo", "Include \"ring.geo\";\n", path);
    assert_false(geo_parameters_read(path, &known, &err));
    geo_parameters_destroy(&known);
    assert_non_null(strstr(err.message, "include each other"));
}

TEST(test_check)
{
    static const struct {
        MeshParameter given[2];
        int32_t count;
        const char *message;
    } rows[] = {{{{"nx", 3, ""}, {"s", 0, "x"}}, 2, NULL},
                {{{"ny", 3, ""}}, 1, "takes no parameter 'ny'; its DefineConstant lists: nx, s"},
                {{{"nx", 0, "x"}}, 1, "'nx' is a number, found the text 'x'"},
                {{{"s", 3, ""}}, 1, "'s' is a text, found the number 3"},
                {{{"nx", 3, ""}, {"nx", 4, ""}}, 2, "'nx' is given twice"},
                {{{"nx", INFINITY, ""}}, 1, "not a finite number"},
                {{{"s", 0, "a\"; x"}}, 1, "holds a quote"}};
    char path[PATH_SIZE];
    Error err = {0};
    GeoParameters known;
    write_file("a.geo", "DefineConstant[ nx = 1, s = \"q\" ];\n", path);
    assert_true(geo_parameters_read(path, &known, &err));
    for (size_t k = 0; k < sizeof rows / sizeof *rows; k++) {
        Error found = {0};
        bool done = geo_parameters_check(&known, path, rows[k].given, rows[k].count, &found);
        assert_int_equal(done, rows[k].message == NULL);
        if (rows[k].message && !strstr(found.message, rows[k].message))
            fail_msg("%s", found.message);
    }
    geo_parameters_destroy(&known);
    write_file("none.geo", "Point(1) = {0, 0, 0};\n", path);
    assert_true(geo_parameters_read(path, &known, &err));
    assert_false(geo_parameters_check(&known, path, rows[0].given, 1, &err));
    assert_non_null(strstr(err.message, "none at all"));
    geo_parameters_destroy(&known);
}

// Each name found in a shipped mesh really changes it: gmsh listens to it.
TEST(test_shipped)
{
    static const char *const meshes[] = {"block.geo", "pads.geo", "grooves.geo"};
    for (int32_t m = 0; m < 3; m++) {
        char path[PATH_SIZE];
        Error err = {0};
        GeoParameters known;
        snprintf(path, sizeof path, "%s/meshes/%s", getenv("AMONTONS_SOURCE"), meshes[m]);
        assert_true(geo_parameters_read(path, &known, &err));
        assert_true(known.count >= 10);
        for (int32_t k = 0; k < known.count; k++) {
            MeshParameter wrong = {.value = -7.5};   // refused by every number of all files
            Error found = {0};
            MeshFile mesh;
            memcpy(wrong.name, known.items[k].name, sizeof wrong.name);
            if (known.items[k].is_text) snprintf(wrong.text, sizeof wrong.text, "wrong");
            assert_false(mesh_file_read(path, &wrong, 1, false, NULL, &mesh, &found));
            mesh_file_destroy(&mesh);
            assert_non_null(strstr(found.message, known.items[k].name));
            assert_non_null(strstr(found.message, wrong.text[0] ? "wrong" : "-7.5"));
        }
        geo_parameters_destroy(&known);
    }
}

// Files that keep the reader busy for ever if each place of them is gone over more than a few
// times, as the clock of ctest tells: 2 MB each. Of what is included the files are counted.
TEST(test_endless)
{
    static const struct {
        const char *begin, *again, *end;
    } cases[] = {{"a", " ", "b"},
                 {"a", "\n", ""},
                 {"a /", "*", "/ b"},
                 {"DefineConstant[", "a,", "];"},
                 {"", "DefineConstant[", ""},
                 {"", "Include ", ""},
                 {"", "Include\t", ""}};
    enum { SIZE = 1 << 21 };
    char path[PATH_SIZE], include[20], *text = malloc(SIZE + 100);
    assert_non_null(text);
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        Error err = {0};
        GeoParameters known;
        char *at = stpcpy(text, cases[k].begin);
        while (at < text + SIZE) at = stpcpy(at, cases[k].again);
        strcpy(at, cases[k].end);
        write_file("long.geo", text, path);
        assert_true(geo_parameters_read(path, &known, &err));
        geo_parameters_destroy(&known);
    }
    for (char name[] = "0.geo"; *name < '8'; ++*name) {
        char *at = text;
        snprintf(include, sizeof include, "Include \"%c.geo\"\n", *name + 1);
        for (int k = 0; k < 50; k++) at = stpcpy(at, include);
        if (*name == '7') *text = 0;
        write_file(name, text, path);
    }
    Error err = {0};
    GeoParameters known;
    write_file("top.geo", "Printf(Include \"0.geo\");\n", path);
    assert_false(geo_parameters_read(path, &known, &err));
    assert_non_null(strstr(err.message, "more than 1000 files are included"));
    geo_parameters_destroy(&known);
    free(text);
}

TEST(test_memory_faults)
{
    char path[PATH_SIZE];
    int64_t live = memory_counters().live;
    bool done = false;
    write_file("a.geo", "DefineConstant[ nx = 1, s = \"q\" ];\n", path);
    for (int64_t k = 0; !done; k++) {
        Error err = {0};
        GeoParameters known;
        memory_fail_after(k);
        done = geo_parameters_read(path, &known, &err);
        memory_fail_after(-1);
        geo_parameters_destroy(&known);
        if (!done) assert_int_equal(err.code, ERROR_MEMORY);
        assert_int_equal(memory_counters().live, live);
    }
}

GROUP_BETWEEN(make_folder, remove_folder);
