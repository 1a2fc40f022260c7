// SPDX-License-Identifier: GPL-2.0-or-later
// Which folders a run may have, and what it takes away from an earlier one.
#include "run/result/result_folder.h"

#include "amontons.h"
#include "base/text.h"
#include "io/files/own_list.h"

#include "place_fixture.h"

#include <fcntl.h>
#include <sys/file.h>

// A whole life of a folder, nothing computed in between.
static bool prepare(const char *path, bool overwrite, Error *err)
{
    ResultFolder folder = {0};
    bool done = result_folder_claim(path, overwrite, &folder, err) &&
                result_folder_clear(&folder, err) && result_folder_settle(&folder, err);
    result_folder_release(&folder);
    return done;
}

static void expect_error(const char *folder, bool overwrite, ErrorCode code, const char *words)
{
    Error err = {0};
    assert_false(prepare(folder, overwrite, &err));
    assert_int_equal(err.code, code);
    if (!strstr(err.message, words)) fail_msg("'%s' is not in: %s", words, err.message);
}

static void write_theirs(const char *const *names, size_t count)
{
    mkdir(place_path(place, "fields"), 0777);
    mkdir(place_path(place, "figures"), 0777);
    for (size_t k = 0; k < count; k++) place_write(place, names[k], "mine");
}

// As a run leaves them: in the list.
static void write_ours(const char *const *names, size_t count)
{
    Error err = {0};
    assert_true(own_list_make(place, &err));
    write_theirs(names, count);
    for (size_t k = 0; k < count; k++) {
        char path[2 * PLACE_SIZE];
        snprintf(path, sizeof path, "%s", place_path(place, names[k]));
        if (text_ends_with(path, ".part")) path[strlen(path) - 5] = 0;
        bool listed = false;
        assert_true(own_list_has(path, &listed, &err) && (listed || own_list_add(path, &err)));
    }
}

static void expect_all(const char *const *names, size_t count, bool there)
{
    for (size_t k = 0; k < count; k++)
        if (place_has(place, names[k]) != there)
            fail_msg("%s is %s", names[k], there ? "gone" : "still there");
}

TEST_BETWEEN(test_made_with_parents, begin, end)
{
    Error err = {0};
    char folder[PLACE_SIZE + 32];
    snprintf(folder, sizeof folder, "%s/a/b/c", place);
    assert_true(prepare(folder, false, &err));
    assert_true(place_has(place, "a/b/c"));
    assert_true(prepare(folder, false, &err));   // empty: once more is fine
    assert_false(place_has(place, "a/b/c/amontons.lock"));
    snprintf(folder, sizeof folder, "%s/d/", place);
    assert_true(prepare(folder, false, &err));
    assert_true(place_has(place, "d"));
}

TEST_BETWEEN(test_refuses_an_earlier_result, begin, end)
{
    const char *const files[] = {"run.json", "history.h5", "history.h5.part", "fields.pvd"};
    for (size_t k = 0; k < sizeof files / sizeof *files; k++) {
        write_ours(&files[k], 1);
        expect_error(place, false, ERROR_INPUT, files[k]);
        expect_error(place, false, ERROR_INPUT, "--overwrite");
        assert_true(place_has(place, files[k]));
        unlink(place_path(place, files[k]));
    }
}

static const char *const OWN[] = {"run.json",
                                  "history.h5",
                                  "fields.pvd",
                                  "fields/bulk_000000.vtu",
                                  "fields/bulk_1000000.vtu.part",
                                  "fields/interface_000003.vtp",
                                  "figures/force.png",
                                  "figures/force.svg",
                                  "figures/panels.png",
                                  "figures/events.csv",
                                  "figures/misfit.csv",
                                  "figures/field-stress_xz.png",
                                  "figures/force.png.part"};
static const char *const OTHERS[] = {"notes.txt",
                                     "scene.yaml",
                                     "history.h5.bak",
                                     "fields/notes.txt",
                                     "fields/bulk.vtu",
                                     "fields/bulk_000001.vtu.old",
                                     "fields/mine_000001.vtu",
                                     "figures/mine.svg",
                                     "figures/field-trip.png",
                                     "figures/photograph.png",
                                     "figures/readme"};
enum { OWN_COUNT = sizeof OWN / sizeof *OWN, OTHER_COUNT = sizeof OTHERS / sizeof *OTHERS };

// Refused, nothing is touched; overwritten, our files go and all others stay.
TEST_BETWEEN(test_overwrites_only_its_own, begin, end)
{
    Error err = {0};
    write_ours(OWN, OWN_COUNT);
    write_theirs(OTHERS, OTHER_COUNT);
    expect_error(place, false, ERROR_INPUT, "holds an earlier result");
    expect_all(OWN, OWN_COUNT, true);
    assert_true(prepare(place, true, &err));
    expect_all(OWN, OWN_COUNT, false);
    expect_all(OTHERS, OTHER_COUNT, true);
}

// A folder with files and no list is somebody's; in one of ours a file that is not in the list is.
// A run that would write over it is refused, and destroys nothing.
TEST_BETWEEN(test_what_is_somebodys_is_not_written_over, begin, end)
{
    const char *const theirs[] = {"history.h5", "run.json", "model1d.json"};
    const char *const ours[] = {"static.json"};
    for (size_t k = 0; k < sizeof theirs / sizeof *theirs; k++) {
        write_theirs(&theirs[k], 1);
        for (int overwrite = 0; overwrite < 2; overwrite++)
            expect_error(place, overwrite, ERROR_INPUT, theirs[k]);
        write_ours(ours, 1);
        expect_error(place, true, ERROR_INPUT, theirs[k]);
        expect_all(&theirs[k], 1, true);
        expect_all(ours, 1, true);
        unlink(place_path(place, theirs[k]));
        unlink(place_path(place, ours[0]));
        unlink(place_path(place, OWN_LIST_NAME));
    }
}

// An error bar that was stopped keeps what it has; the same command begins anew.
TEST_BETWEEN(test_a_stopped_search_may_begin_anew, begin, end)
{
    Error err = {0};
    const char *const kept[] = {"figures/accuracy.json"};
    write_ours(kept, 1);
    assert_true(prepare(place, false, &err));
    expect_all(kept, 1, true);
}

// Until the input is accepted nothing goes, and then nothing behind a link.
TEST_BETWEEN(test_cleared_late_and_not_through_links, begin, end)
{
    Error err = {0};
    ResultFolder folder;
    char elsewhere[PLACE_SIZE];
    place_make(elsewhere);
    const char *const ours[] = {"run.json", "figures/force.svg"};
    place_write(elsewhere, "other.svg", "mine");
    write_ours(ours, 2);
    unlink(place_path(place, ours[1]));
    rmdir(place_path(place, "figures"));
    assert_int_equal(symlink(elsewhere, place_path(place, "figures")), 0);
    assert_true(result_folder_claim(place, true, &folder, &err));
    assert_false(result_folder_is_ours(&folder));
    assert_true(place_has(place, "run.json"));
    assert_true(result_folder_clear(&folder, &err));
    assert_true(result_folder_is_ours(&folder));
    assert_false(place_has(place, "run.json"));
    assert_true(place_has(elsewhere, "other.svg"));
    result_folder_release(&folder);
    place_remove(elsewhere);
}

// Cleared files are back where the new computation did not come to its first step, also where it
// was killed: `moment` is the name that its folder has then.
TEST_BETWEEN(test_back_until_settled, begin, end)
{
    Error err = {0};
    ResultFolder folder;
    static const char *const moments[] = {"amontons.aside", "amontons.earlier", "amontons.gone"};
    for (size_t k = 0; k < 4; k++) {
        write_ours(OWN, OWN_COUNT);
        assert_true(result_folder_claim(place, true, &folder, &err));
        assert_true(result_folder_clear(&folder, &err));
        expect_all(OWN, OWN_COUNT, false);
        assert_false(result_folder_is_settled(&folder));
        if (k > 0) {   // of the new computation, which wrote none before its earlier one was aside
            assert_true(own_list_add(place_path(place, "report.html"), &err));
            place_write(place, "report.html", "new");
        }
        char now[PLACE_SIZE + 40];
        snprintf(now, sizeof now, "%s", place_path(place, "amontons.earlier"));
        if (k < 3) {
            folder.aside = false;   // killed
            assert_int_equal(rename(now, place_path(place, moments[k])), 0);
        }
        result_folder_release(&folder);
        if (k < 3) expect_all(OWN, OWN_COUNT, false);
        if (k < 3) assert_true(result_folder_claim(place, true, &folder, &err));
        result_folder_release(&folder);
        expect_all(OWN, OWN_COUNT, k != 2);
        assert_int_equal(place_has(place, "report.html"), k == 2);
        assert_false(place_has(place, "amontons.earlier") || place_has(place, "amontons.aside") ||
                     place_has(place, "amontons.gone"));
        assert_true(prepare(place, true, &err));
        expect_all(OWN, OWN_COUNT, false);
    }
}

// A result that somebody sent, with files set aside: what is put back comes into its own folder,
// not through a link in it, and a folder is never moved in a file's stead.
TEST_BETWEEN(test_back_inside_of_the_folder, begin, end)
{
    Error err = {0};
    char elsewhere[PLACE_SIZE], text[16];
    static const char *const moments[] = {"amontons.aside", "amontons.earlier"};
    for (size_t k = 0; k < 2; k++) {
        place_make(elsewhere);
        place_write(elsewhere, "keys", "mine");
        assert_true(own_list_make(place, &err));
        assert_int_equal(mkdir(place_path(place, "amontons.aside"), 0777), 0);
        assert_int_equal(mkdir(place_path(place, "amontons.aside/d"), 0777), 0);
        place_write(place, "amontons.aside/" OWN_LIST_NAME, "d/keys\nd/more\n");
        place_write(place, "amontons.aside/d/keys", "theirs");
        assert_int_equal(mkdir(place_path(place, "amontons.aside/d/more"), 0777), 0);
        assert_int_equal(symlink(elsewhere, place_path(place, "d")), 0);
        if (k > 0) {
            char now[2 * PLACE_SIZE];
            snprintf(now, sizeof now, "%s", place_path(place, "amontons.aside"));
            assert_int_equal(rename(now, place_path(place, moments[k])), 0);
        }
        expect_error(place, false, ERROR_INPUT, "d is a symbolic link");
        place_read(elsewhere, "keys", text, sizeof text);
        assert_string_equal(text, "mine");
        assert_false(place_has(elsewhere, "more"));

        // With a folder in the link's place the file is back, and the folder is not.
        unlink(place_path(place, "d"));
        ResultFolder folder;
        result_folder_claim(place, true, &folder, &err);
        result_folder_release(&folder);
        error_clear(&err);
        place_read(place, "d/keys", text, sizeof text);
        assert_string_equal(text, "theirs");
        assert_false(place_has(place, "d/more"));
        place_remove(elsewhere);
        place_remove(place);
        assert_int_equal(mkdir(place, 0777), 0);
    }
}

// The second of two is told who holds the folder; when that has let go, it may.
TEST_BETWEEN(test_one_computation_at_a_time, begin, end)
{
    Error err = {0};
    ResultFolder first;
    char holder[64];
    snprintf(holder, sizeof holder, "process %ld on ", (long)getpid());
    assert_true(result_folder_claim(place, true, &first, &err));
    expect_error(place, true, ERROR_INPUT, "another computation");
    expect_error(place, true, ERROR_INPUT, holder);
    result_folder_release(&first);
    assert_true(prepare(place, true, &err));
}

// Somebody holds it who has not said who that is; the file that he leaves is taken over.
TEST_BETWEEN(test_locks, begin, end)
{
    Error err = {0};
    ResultFolder own;
    place_write(place, "amontons.lock", "");
    int other = open(place_path(place, "amontons.lock"), O_RDWR);
    assert_int_equal(flock(other, LOCK_EX), 0);
    expect_error(place, true, ERROR_INPUT, "(its process is not known)");
    close(other);
    assert_true(result_folder_claim(place, true, &own, &err));
    assert_true(place_has(place, "amontons.lock"));
    result_folder_release(&own);
    assert_false(place_has(place, "amontons.lock"));
}

TEST_BETWEEN(test_impossible_folders, begin, end)
{
    char folder[PLACE_SIZE + 32];
    place_write(place, "file", "x");
    snprintf(folder, sizeof folder, "%s/file", place);
    expect_error(folder, true, ERROR_INPUT, "is a file, not a folder");
    snprintf(folder, sizeof folder, "%s/file/below", place);
    expect_error(folder, true, ERROR_INPUT, "cannot make the folder");
    char endless[9000];
    memset(endless, 'x', sizeof endless);
    endless[sizeof endless - 1] = 0;
    expect_error(endless, true, ERROR_INPUT, "too long");
    enum { NOBODY = 65534 };
    bool root = geteuid() == 0;   // who writes anywhere
    snprintf(folder, sizeof folder, "%s/locked", place);
    assert_int_equal(mkdir(folder, 0555), 0);
    if (root) assert_int_equal(chmod(place, 0755) || setresuid(NOBODY, NOBODY, 0), 0);
    expect_error(folder, true, ERROR_FILE, "cannot write into");
    if (root) assert_int_equal(setresuid(0, 0, 0), 0);
}
