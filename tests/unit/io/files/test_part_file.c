// SPDX-License-Identifier: GPL-2.0-or-later
// A final name leads to a whole file or to none, also with two writers and with readers that hold
// the earlier file.
#include "io/files/own_list.h"
#include "io/files/part_file.h"

#include "cases.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static char folder[64];
static char path[128], part[136];

FIXTURE(make_folder)
{
    snprintf(folder, sizeof folder, "/tmp/amontons_part_XXXXXX");
    if (!mkdtemp(folder)) return -1;
    snprintf(path, sizeof path, "%s/result", folder);
    snprintf(part, sizeof part, "%s.part", path);
    return own_list_make(folder, &(Error){0}) ? 0 : -1;
}

FIXTURE(remove_folder)
{
    char list[128];
    snprintf(list, sizeof list, "%s/" OWN_LIST_NAME, folder);
    unlink(list);
    return rmdir(folder);   // fails when a test left anything
}

FIXTURE(forget_files)
{
    unlink(path);
    unlink(part);
    return 0;
}

// The content of `name`, of at most 63 letters; "none" where there is no such file.
static const char *content(const char *name, char text[64])
{
    memset(text, 0, 64);
    int descriptor = open(name, O_RDONLY);
    if (descriptor < 0) return strcpy(text, "none");
    assert_true(read(descriptor, text, 63) >= 0);
    close(descriptor);
    return text;
}

static void assert_content(const char *name, const char *expected)
{
    char text[64];
    assert_string_equal(content(name, text), expected);
}

static void create(PartFile *file, const char *text)
{
    Error err = {0};
    if (!part_file_create(file, path, &err)) fail_msg("%s", err.message);
    assert_true(part_file_write(file, text, (int64_t)strlen(text), &err));
}

TEST_BETWEEN(commit_gives_the_name_and_leave_does_not, NULL, forget_files)
{
    Error err = {0};
    PartFile file;
    create(&file, "first");
    assert_content(path, "none");
    assert_content(part, "first");
    assert_true(part_file_commit(&file, &err));
    assert_content(path, "first");
    assert_content(part, "none");

    create(&file, "second");
    part_file_leave(&file);
    assert_content(path, "first");
    assert_content(part, "second");

    create(&file, "3");   // over the longer remains
    assert_content(part, "3");
    part_file_discard(&file);
    part_file_discard(&file);
    part_file_leave(&file);
    assert_content(path, "first");
    assert_content(part, "none");
}

// Who was killed takes a moment to end.
TEST(a_writer_that_ends_is_waited_for)
{
    int ends[2];
    char byte = 0;
    assert_int_equal(pipe(ends), 0);
    pid_t child = fork();
    if (child == 0) {
        PartFile file;
        Error err = {0};
        bool done = part_file_create(&file, path, &err) && write(ends[1], "x", 1) == 1;
        usleep(50000);
        _exit(done ? 0 : 1);
    }
    assert_int_equal(read(ends[0], &byte, 1), 1);
    PartFile file;
    create(&file, "after");
    part_file_discard(&file);
    int status = 1;
    waitpid(child, &status, 0);
    assert_int_equal(status, 0);
    close(ends[0]);
    close(ends[1]);
}

// Through none of these may anything be written: a link, a pipe that nobody reads, a second name,
// somebody's file; the last gives way to who says so.
TEST_BETWEEN(what_stands_in_the_place_of_the_part, NULL, forget_files)
{
    char mine[140], taken[140], left[150];   // no list has them
    snprintf(taken, sizeof taken, "%s/unlisted", folder);
    snprintf(left, sizeof left, "%s.part", taken);
    Error err = {0};
    PartFile file;
    bool listed = true;
    snprintf(mine, sizeof mine, "%s/mine", folder);
    FILE *stream = fopen(mine, "w");
    assert_true(stream && fputs("mine", stream) >= 0 && fclose(stream) == 0);
    static const char *const words[] = {"a symbolic link", "a pipe (FIFO)", "a second name",
                                        "unlisted.part is there already"};
    for (int k = 0; k < 4; k++) {
        if (k == 0) assert_int_equal(symlink(mine, left), 0);
        if (k == 1) assert_int_equal(mkfifo(left, 0600), 0);
        if (k == 2) assert_int_equal(link(mine, left), 0);
        if (k == 3) assert_int_equal(rename(mine, left), 0);
        error_clear(&err);
        assert_false(part_file_create(&file, taken, &err));
        assert_int_equal(err.code, k < 3 ? ERROR_FILE : ERROR_INPUT);
        if (!strstr(err.message, words[k])) fail_msg("%s", err.message);
        part_file_discard(&file);
        assert_content(k < 3 ? mine : left, "mine");
        assert_true(own_list_has(taken, &listed, &(Error){0}) && !listed);
        if (k < 3) unlink(left);
    }
    error_clear(&err);
    assert_true(part_file_replace(&file, taken, true, &err));
    assert_content(left, "");
    part_file_discard(&file);
}

// A file that is not in the list is somebody's, also where the word of a list is in it.
TEST_BETWEEN(somebodys_file_gives_way_to_overwrite_alone, NULL, forget_files)
{
    Error err = {0};
    PartFile file;
    char mine[140];
    snprintf(mine, sizeof mine, "%s/history.h5", folder);
    FILE *stream = fopen(mine, "w");
    assert_true(stream && fputs("series of mine", stream) >= 0 && fclose(stream) == 0);
    assert_false(part_file_create(&file, mine, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    assert_content(mine, "series of mine");
    error_clear(&err);
    assert_true(part_file_replace(&file, mine, true, &err) && part_file_commit(&file, &err));
    assert_content(mine, "");
    bool listed = false;
    assert_true(own_list_has(mine, &listed, &err) && listed);
    assert_true(part_file_create(&file, mine, &err) && part_file_commit(&file, &err));
    unlink(mine);
}

TEST_BETWEEN(two_writers_do_not_meet, NULL, forget_files)
{
    Error err = {0};
    PartFile file, other;
    create(&file, "mine");
    assert_false(part_file_create(&other, path, &err));
    assert_int_equal(err.code, ERROR_FILE);
    assert_non_null(strstr(err.message, "another process is writing"));
    part_file_discard(&other);
    assert_content(part, "mine");   // not even emptied
    error_clear(&err);
    assert_true(part_file_commit(&file, &err));
    create(&other, "theirs");
    assert_content(path, "mine");
    assert_true(part_file_commit(&other, &err));
    assert_content(path, "theirs");
}

TEST_BETWEEN(a_reader_keeps_the_file_it_opened, NULL, forget_files)
{
    Error err = {0};
    PartFile file;
    char text[64] = {0};
    create(&file, "old");
    assert_true(part_file_commit(&file, &err));
    int reader = open(path, O_RDONLY);
    create(&file, "new one");
    assert_true(part_file_commit(&file, &err));
    assert_int_equal(read(reader, text, 63), 3);
    close(reader);
    assert_string_equal(text, "old");
    assert_content(path, "new one");
}

TEST_BETWEEN(a_failed_commit_keeps_what_was_written, NULL, forget_files)
{
    Error err = {0};
    PartFile file;
    create(&file, "hours of work");
    assert_int_equal(mkdir(path, 0777), 0);   // nothing can be renamed onto a folder
    assert_false(part_file_commit(&file, &err));
    assert_int_equal(err.code, ERROR_FILE);
    assert_non_null(strstr(err.message, path));
    assert_non_null(strstr(err.message, "Is a directory"));
    part_file_leave(&file);
    assert_content(part, "hours of work");
    assert_int_equal(rmdir(path), 0);
}

TEST(names_are_checked)
{
    Error err = {0};
    PartFile file;
    static char name[PATH_MAX + 20], longer[PATH_MAX + 8];
    assert_true(part_file_name("a/b.h5", longer));
    assert_string_equal(longer, "a/b.h5.part");
    memset(name, 'a', sizeof name - 1);
    assert_false(part_file_name(name, longer));
    assert_false(part_file_name("", longer));
    assert_false(part_file_create(&file, name, &err));
    assert_non_null(strstr(err.message, "too long"));
    error_clear(&err);
    name[300] = '\0';   // fits, but no file system takes it
    assert_false(part_file_create(&file, name, &err));
    assert_non_null(strstr(err.message, "File name too long"));
    error_clear(&err);
    assert_false(part_file_create(&file, "/dev/null/x", &err));
    assert_non_null(strstr(err.message, "/dev/null/x: Not a directory"));
}

// /dev/full takes nothing: every write fails as on a full disk.
TEST_BETWEEN(a_full_disk_is_said, NULL, forget_files)
{
    Error err = {0};
    PartFile file;
    create(&file, "");
    int full = open("/dev/full", O_WRONLY);
    assert_true(dup2(full, file.descriptor) == file.descriptor);
    close(full);
    assert_false(part_file_write(&file, "x", 1, &err));
    assert_int_equal(err.code, ERROR_FILE);
    assert_non_null(strstr(err.message, path));
    assert_non_null(strstr(err.message, "No space left on device"));
    part_file_discard(&file);
    assert_content(part, "none");
}

GROUP_BETWEEN(make_folder, remove_folder);
