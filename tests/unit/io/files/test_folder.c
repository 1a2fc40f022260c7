// SPDX-License-Identifier: GPL-2.0-or-later
#include "io/files/folder.h"

#include "place_fixture.h"

#include <errno.h>
#include <limits.h>

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

// --- inside of a folder that somebody sent: nothing outside is opened or made --------------------

static void expect(const char *root, const char *name, const char *words)
{
    Error err = {0};
    bool good = folder_check_inside(root, name, &err);
    if (!words && !good) fail_msg("%s: %s", name, err.message);
    if (!words) return;
    if (good) fail_msg("%s is let through", name);
    assert_int_equal(err.code, ERROR_INPUT);
    if (!strstr(err.message, words)) fail_msg("'%s' is not in: %s", words, err.message);
}

TEST_BETWEEN(test_no_link_is_followed, begin, end)
{
    char elsewhere[PLACE_SIZE], linked[PLACE_SIZE + 32];
    place_make(elsewhere);
    place_write(elsewhere, "secret", "s");
    mkdir(place_path(place, "figures"), 0777);
    place_write(place, "figures/force.png", "p");
    assert_int_equal(symlink(elsewhere, place_path(place, "fields")), 0);
    assert_int_equal(symlink("figures", place_path(place, "near")), 0);
    assert_int_equal(symlink("nowhere", place_path(place, "figures/lost")), 0);
    snprintf(linked, sizeof linked, "%s/../%s-link", place, strrchr(place, '/') + 1);
    assert_int_equal(symlink(place, linked), 0);
    const char *const roots[] = {place, linked};   // the root itself may be a link
    for (int k = 0; k < 2; k++) {
        expect(roots[k], "", NULL);
        expect(roots[k], "figures", NULL);
        expect(roots[k], "figures/force.png", NULL);
        expect(roots[k], "./figures//force.png", NULL);
        expect(roots[k], "figures/../figures/force.png", NULL);
        expect(roots[k], "none/at/all", NULL);
        expect(roots[k], "figures/force.png/below", NULL);   // who opens it says so
        expect(roots[k], "fields", "fields is a symbolic link");
        expect(roots[k], "fields/secret", "fields is a symbolic link");
        expect(roots[k], "fields/../run.json", "fields is a symbolic link");
        expect(roots[k], "near/force.png", "near is a symbolic link");
        expect(roots[k], "figures/lost", "figures/lost is a symbolic link");
        expect(roots[k], "..", "leads out of");
        expect(roots[k], "figures/../../x", "leads out of");
        expect(roots[k], "/etc/passwd", "leads out of");
    }
    expect("/proc/none", "x", NULL);
    unlink(linked);
    place_remove(elsewhere);
}

TEST_BETWEEN(test_folders_are_made_inside, begin, end)
{
    Error err = {0};
    char elsewhere[PLACE_SIZE], root[PLACE_SIZE + 32];
    place_make(elsewhere);
    snprintf(root, sizeof root, "%s/new/outer", place);
    assert_true(folder_make_inside(root, "points/0", &err));
    assert_true(folder_make_inside(root, "points/0", &err));   // it is there
    assert_true(place_has(place, "new/outer/points/0"));
    assert_int_equal(symlink(elsewhere, place_path(place, "figures")), 0);
    place_write(place, "file", "x");
    static const char *const wrong[] = {"figures", "figures/below", "../out", "file", "file/below"};
    static const char *const words[] = {"is a symbolic link", "is a symbolic link", "leads out of",
                                        "is a file", "is a file"};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        assert_false(folder_make_inside(place, wrong[k], &err));
        assert_int_equal(err.code, ERROR_INPUT);
        if (!strstr(err.message, words[k])) fail_msg("%s", err.message);
        error_clear(&err);
    }
    assert_false(place_has(elsewhere, "below"));
    place_remove(elsewhere);
}

TEST_BETWEEN(test_open_folders, begin, end)
{
    char lengthy[400];
    memset(lengthy, 'x', sizeof lengthy);
    lengthy[sizeof lengthy - 1] = 0;
    mkdir(place_path(place, "figures"), 0777);
    assert_int_equal(symlink("figures", place_path(place, "near")), 0);
    int folder = folder_open_inside(place, "figures", false);
    assert_true(folder >= 0);
    close(folder);
    const struct {
        const char *name;
        int cause;
    } wrong[] = {
        {"near", ELOOP}, {"none", ENOENT}, {"..", EXDEV}, {"/", EXDEV}, {lengthy, ENAMETOOLONG}};
    for (size_t k = 0; k < sizeof wrong / sizeof *wrong; k++) {
        assert_int_equal(folder_open_inside(place, wrong[k].name, false), -1);
        assert_int_equal(errno, wrong[k].cause);
    }
    folder = folder_open_inside(place, "made/here", true);
    assert_true(folder >= 0 && place_has(place, "made/here"));
    close(folder);
}
