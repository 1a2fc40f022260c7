// SPDX-License-Identifier: GPL-2.0-or-later
// Whose a folder and a file is, also where the list is a stranger's.
#include "io/files/own_list.h"

#include "place_fixture.h"

static bool has_path(const char *path)
{
    Error err = {0};
    bool listed = false;
    if (!own_list_has(path, &listed, &err)) fail_msg("%s", err.message);
    return listed;
}

static bool has(const char *name)
{
    return has_path(place_path(place, name));
}

static void add(const char *name)
{
    Error err = {0};
    if (!own_list_add(place_path(place, name), &err)) fail_msg("%s", err.message);
}

TEST_BETWEEN(test_an_empty_folder_becomes_ours, begin, end)
{
    Error err = {0};
    assert_true(own_list_check(place_path(place, "not-there"), &err));
    assert_true(own_list_check(place, &err));
    add("run.json");   // no list: nothing is noted
    assert_false(has("run.json") || own_list_is_in(place));
    place_write(place, ".hidden", "");
    place_write(place, "amontons.lock", "");
    assert_true(own_list_check(place, &err));
    assert_true(own_list_make(place, &err));
    place_write(place, "notes.txt", "mine");
    assert_true(own_list_check(place, &err) && own_list_make(place, &err));
    assert_false(has("notes.txt"));
    add("run.json");
    mkdir(place_path(place, "figures"), 0777);
    add("figures/force.png");
    assert_true(has("run.json") && has("figures/force.png"));
    assert_false(has("run.jso") || has("un.json") || has("force.png") || has("figures/run.json"));
}

TEST_BETWEEN(test_a_folder_of_others_is_refused, begin, end)
{
    Error err = {0};
    place_write(place, "history.h5", "series");
    assert_false(own_list_check(place, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    assert_non_null(strstr(err.message, "history.h5"));
    error_clear(&err);
    place_write(place, "elsewhere", "");   // a link to a list is none
    assert_int_equal(symlink("elsewhere", place_path(place, OWN_LIST_NAME)), 0);
    assert_false(own_list_is_in(place) || own_list_check(place, &err));
    error_clear(&err);
    assert_false(own_list_make(place, &err));
    char text[8];
    place_read(place, "elsewhere", text, sizeof text);
    assert_string_equal(text, "");
}

// The list of a result that somebody sent: nothing outside of its folder is ours for it.
TEST_BETWEEN(test_a_strangers_list, begin, end)
{
    Error err = {0};
    char elsewhere[PLACE_SIZE];
    place_write(place, OWN_LIST_NAME,
                "# a list\n../notes.txt\n/etc/passwd\n.profile\nfigures/../../x\nfigures/.x\n"
                "a/b/c\nfigures//x\nfigures/\n\n\x1b[2J\nrun.json\nfields/a b.vtu\ncut");
    static const char *const kept[] = {"run.json", "fields/a b.vtu", "cut"};
    char name[OWN_NAME_SIZE];
    FILE *list = own_list_open(place, &err);
    assert_non_null(list);
    for (size_t k = 0; k < sizeof kept / sizeof *kept; k++) {
        assert_true(own_list_next(list, name));
        assert_string_equal(name, kept[k]);
    }
    assert_false(own_list_next(list, name));
    fclose(list);
    assert_false(has("../notes.txt") || has(".profile") || has("cut"));
    place_make(elsewhere);   // a folder behind a link is not in ours
    assert_int_equal(symlink(elsewhere, place_path(place, "fields")), 0);
    assert_false(has("fields/a b.vtu"));
    unlink(place_path(place, "fields"));
    mkdir(place_path(place, "fields"), 0777);
    assert_true(has("fields/a b.vtu"));
    place_remove(elsewhere);
}

// A link in a folder of ours leads to another folder with a list, which is somebody else's. The
// folder of a result itself may be a link.
TEST_BETWEEN(test_a_list_behind_a_link, begin, end)
{
    Error err = {0};
    char elsewhere[PLACE_SIZE], link[PLACE_SIZE + 40];
    place_make(elsewhere);
    assert_true(own_list_make(elsewhere, &err));
    snprintf(link, sizeof link, "%s/force.png", elsewhere);
    assert_true(own_list_add(link, &err));
    assert_int_equal(symlink(elsewhere, place_path(place, "figures")), 0);
    assert_true(has("figures/force.png"));
    add("figures/new.png");
    assert_true(has("figures/new.png"));
    assert_true(own_list_make(place, &err));
    assert_false(has("figures/force.png"));
    add("figures/newer.png");
    unlink(place_path(place, OWN_LIST_NAME));
    assert_false(has("figures/newer.png"));
    place_remove(elsewhere);
}

// Names without a slash, and folders that end in one.
TEST_BETWEEN(test_from_the_working_folder, begin, end)
{
    Error err = {0};
    char path[PLACE_SIZE + 40], before[PATH_MAX];
    assert_non_null(getcwd(before, sizeof before));
    assert_int_equal(chdir(place), 0);
    assert_true(own_list_make(".", &err));
    mkdir("figures", 0777);
    assert_true(own_list_add("run.json", &err) && own_list_add("figures/force.png", &err));
    assert_true(has_path("run.json") && has_path("./run.json"));
    assert_true(has_path("./figures/force.png"));
    snprintf(path, sizeof path, "%s//figures/force.png", place);
    assert_true(has_path(path));
    assert_int_equal(chdir(before), 0);
}
