// SPDX-License-Identifier: GPL-2.0-or-later
#include "io/files/folder.h"

#include "near.h"

#include <limits.h>
#include <sys/stat.h>
#include <unistd.h>

static void assert_makes(const char *path)
{
    Error err = {0};
    struct stat what;
    if (!folder_make(path, &err)) fail_msg("%s", err.message);
    assert_int_equal(stat(path, &what), 0);
    assert_true(S_ISDIR(what.st_mode));
}

static void assert_fails(const char *path, ErrorCode code, const char *words)
{
    Error err = {0};
    assert_false(folder_make(path, &err));
    assert_int_equal(err.code, code);
    if (!strstr(err.message, words)) fail_msg("%s", err.message);
}

// All that leads there, twice, with slashes where nobody needs them; what cannot be is told.
TEST(test_folders)
{
    char root[] = "/tmp/amontons-folder-XXXXXX", path[256], below[300], lengthy[PATH_MAX + 10];
    assert_non_null(mkdtemp(root));
    snprintf(path, sizeof path, "%s//a/b/", root);
    assert_makes(path);
    assert_makes(path);
    assert_int_equal(chdir(root), 0);
    assert_makes("c/d");
    assert_makes("e");
    snprintf(path, sizeof path, "%s/file", root);
    fclose(fopen(path, "w"));
    snprintf(below, sizeof below, "%s/under", path);
    assert_fails(below, ERROR_INPUT, "under: Not a directory");
    memset(lengthy, 'x', sizeof lengthy);
    lengthy[sizeof lengthy - 1] = 0;
    assert_fails(lengthy, ERROR_INPUT, "too long");
    snprintf(path, sizeof path, "rm -rf %s", root);
    assert_int_equal(system(path), 0);
}

static void assert_seen(const char *folder, const char *file, const char *wanted)
{
    char path[PATH_MAX];
    folder_relative(folder, file, path, sizeof path);
    assert_string_equal(path, wanted);
}

// A path as a reader in the folder would type it; links and detours are gone.
TEST(test_files_seen_from_a_folder)
{
    char root[] = "/tmp/amontons-folder-XXXXXX", path[256];
    assert_non_null(mkdtemp(root));
    assert_int_equal(chdir(root), 0);
    assert_makes("scenes");
    assert_makes("results/fig1");
    assert_makes("results/fig10");
    fclose(fopen("scenes/m.geo", "w"));
    fclose(fopen("results/fig1/m.geo", "w"));
    assert_int_equal(symlink("scenes", "link"), 0);
    assert_seen("results/fig1", "scenes/m.geo", "../../scenes/m.geo");
    assert_seen("results/fig1", "link/../scenes/m.geo", "../../scenes/m.geo");
    assert_seen("results/fig1/", "link/m.geo", "../../scenes/m.geo");
    assert_seen("results/fig1", "results/fig1/m.geo", "m.geo");
    assert_seen("results/fig10", "results/fig1/m.geo", "../fig1/m.geo");
    assert_seen(".", "scenes/m.geo", "scenes/m.geo");
    snprintf(path, sizeof path, "%s/scenes/m.geo", root + 1);
    assert_seen("/", "scenes/m.geo", path);
    assert_seen("results", "none.geo", "none.geo");
    assert_seen("none", "scenes/m.geo", "scenes/m.geo");
    assert_int_equal(chdir("/"), 0);
    snprintf(path, sizeof path, "rm -rf %s", root);
    assert_int_equal(system(path), 0);
}
