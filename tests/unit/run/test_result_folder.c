// SPDX-License-Identifier: GPL-2.0-or-later
// Which folders a run may have, and what it takes away from an earlier one.
#include "run/result_folder.h"

#include "result_place.h"

static char place[PLACE_SIZE];

static int setup(void **state)
{
    (void)state;
    place_make(place);
    return 0;
}

static int teardown(void **state)
{
    (void)state;
    place_remove(place);
    return 0;
}

static void expect_error(const char *folder, bool overwrite, ErrorCode code, const char *words)
{
    Error err = {0};
    assert_false(result_folder_prepare(folder, overwrite, &err));
    assert_int_equal(err.code, code);
    if (!strstr(err.message, words)) fail_msg("'%s' is not in: %s", words, err.message);
}

static void test_made_with_parents(void **state)
{
    (void)state;
    Error err = {0};
    char folder[PLACE_SIZE + 32];
    snprintf(folder, sizeof folder, "%s/a/b/c", place);
    assert_true(result_folder_prepare(folder, false, &err));
    assert_true(place_has(place, "a/b/c"));
    assert_true(result_folder_prepare(folder, false, &err));   // empty: once more is fine
    snprintf(folder, sizeof folder, "%s/d/", place);
    assert_true(result_folder_prepare(folder, false, &err));
    assert_true(place_has(place, "d"));
}

static void test_refuses_an_earlier_result(void **state)
{
    (void)state;
    const char *const files[] = {"run.json", "history.h5", "history.h5.part", "fields.pvd"};
    for (size_t k = 0; k < sizeof files / sizeof *files; k++) {
        place_write(place, files[k], "kept");
        expect_error(place, false, ERROR_INPUT, files[k]);
        expect_error(place, false, ERROR_INPUT, "--overwrite");
        assert_true(place_has(place, files[k]));
        unlink(place_path(place, files[k]));
    }
}

// Refused, nothing is touched; overwritten, our files go and all others stay.
static void test_overwrites_only_its_own(void **state)
{
    (void)state;
    Error err = {0};
    const char *const own[] = {"run.json",
                               "history.h5",
                               "fields.pvd",
                               "fields/bulk_000000.vtu",
                               "fields/interface_000003.vtp",
                               "figures/force.png",
                               "figures/force.png.part"};
    const char *const others[] = {"notes.txt",        "scene.yaml",        "history.h5.bak",
                                  "fields/notes.txt", "figures/force.svg", "figures/readme"};
    mkdir(place_path(place, "fields"), 0777);
    mkdir(place_path(place, "figures"), 0777);
    for (size_t k = 0; k < sizeof own / sizeof *own; k++) place_write(place, own[k], "x");
    for (size_t k = 0; k < sizeof others / sizeof *others; k++) place_write(place, others[k], "x");
    expect_error(place, false, ERROR_INPUT, "holds an earlier result");
    for (size_t k = 0; k < sizeof own / sizeof *own; k++) assert_true(place_has(place, own[k]));
    assert_true(result_folder_prepare(place, true, &err));
    for (size_t k = 0; k < sizeof own / sizeof *own; k++)
        if (place_has(place, own[k])) fail_msg("%s is still there", own[k]);
    for (size_t k = 0; k < sizeof others / sizeof *others; k++)
        if (!place_has(place, others[k])) fail_msg("%s is gone", others[k]);
}

static void test_impossible_folders(void **state)
{
    (void)state;
    char folder[PLACE_SIZE + 32];
    place_write(place, "file", "x");
    snprintf(folder, sizeof folder, "%s/file", place);
    expect_error(folder, true, ERROR_FILE, "is a file, not a folder");
    snprintf(folder, sizeof folder, "%s/file/below", place);
    expect_error(folder, true, ERROR_FILE, "cannot make the result folder");
    char endless[9000];
    memset(endless, 'x', sizeof endless);
    endless[sizeof endless - 1] = 0;
    expect_error(endless, true, ERROR_INPUT, "too long");
    if (geteuid() == 0) return;   // root writes anywhere
    snprintf(folder, sizeof folder, "%s/locked", place);
    mkdir(folder, 0555);
    expect_error(folder, true, ERROR_FILE, "cannot write into");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(test_made_with_parents, setup, teardown),
        cmocka_unit_test_setup_teardown(test_refuses_an_earlier_result, setup, teardown),
        cmocka_unit_test_setup_teardown(test_overwrites_only_its_own, setup, teardown),
        cmocka_unit_test_setup_teardown(test_impossible_folders, setup, teardown),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
