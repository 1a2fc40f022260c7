// SPDX-License-Identifier: GPL-2.0-or-later
// Whole files: sizes around the buffer's, marks, pipes, what is refused; memory running out.
#include "io/files/text_file.h"

#include "base/memory.h"
#include "cases.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

static char folder[] = "/tmp/amontons_text_XXXXXX", path[64];

// `size` bytes, none of them zero, that tell their places.
static void write_bytes(int32_t size)
{
    FILE *file = fopen(path, "wb");
    assert_non_null(file);
    for (int32_t k = 0; k < size; k++) fputc('!' + k % 90, file);
    assert_int_equal(fclose(file), 0);
}

static void check_bytes(const char *bytes, int32_t size, int32_t wanted)
{
    assert_int_equal(size, wanted);
    for (int32_t k = 0; k < size; k++) assert_int_equal(bytes[k], '!' + k % 90);
    assert_int_equal(bytes[size], 0);
}

TEST(test_sizes)
{
    static const int32_t sizes[] = {0, 1, 4095, 4096, 4097, 8192, 100000};
    for (size_t k = 0; k < sizeof sizes / sizeof sizes[0]; k++) {
        Error err = {0};
        char *bytes = NULL;
        int32_t size = -1;
        write_bytes(sizes[k]);
        if (!text_file_read(path, 100000, &bytes, &size, &err)) fail_msg("%s", err.message);
        check_bytes(bytes, size, sizes[k]);
        memory_free(bytes);
    }
}

TEST(test_zero_byte)
{
    Error err = {0};
    char *bytes = NULL;
    int32_t size = 0;
    FILE *file = fopen(path, "wb");
    fwrite("one\ntw\0o\n", 1, 9, file);
    fclose(file);
    assert_false(text_file_read(path, 100, &bytes, &size, &err));
    assert_null(bytes);
    assert_int_equal(err.code, ERROR_INPUT);
    assert_non_null(strstr(err.message, "a zero byte in line 2"));
    err = (Error){0};
    assert_true(text_file_bytes(path, 100, &bytes, &size, &err));
    assert_int_equal(size, 9);
    memory_free(bytes);
}

TEST(test_byte_order_mark)
{
    Error err = {0};
    char *bytes = NULL;
    int32_t size = 0;
    FILE *file = fopen(path, "wb");
    fputs("\xEF\xBB\xBFkey: \xEF\xBB\xBF", file);
    fclose(file);
    assert_true(text_file_read(path, 100, &bytes, &size, &err));
    assert_string_equal(bytes, "key: \xEF\xBB\xBF");   // at the start only
    assert_int_equal(size, 8);
    memory_free(bytes);
}

// A pipe of the shell, <(command), says 0 bytes and has more: refused when they have come, like a
// file that is too long.
TEST(test_pipe)
{
    for (int32_t most = 4999; most <= 5000; most++) {
        Error err = {0};
        char *bytes = NULL;
        int32_t size = 0;
        int ends[2];
        char name[32];
        assert_int_equal(pipe(ends), 0);
        snprintf(name, sizeof name, "/dev/fd/%d", ends[0]);
        write_bytes(5000);
        pid_t writer = fork();
        if (writer == 0) {
            char all[5000];
            FILE *file = fopen(path, "rb");
            bool whole = fread(all, 1, sizeof all, file) == sizeof all;
            _exit(whole && write(ends[1], all, sizeof all) == sizeof all ? 0 : 1);
        }
        close(ends[1]);
        bool read = text_file_read(name, most, &bytes, &size, &err);
        close(ends[0]);
        waitpid(writer, NULL, 0);
        assert_int_equal(read, most == 5000);
        if (read) check_bytes(bytes, size, 5000);
        if (!read) assert_int_equal(err.code, ERROR_INPUT);
        memory_free(bytes);
        unlink(path);
    }
}

// Nobody may ever write into it.
TEST(test_named_pipe)
{
    Error err = {0};
    char *bytes = NULL;
    int32_t size = 0;
    unlink(path);
    assert_int_equal(mkfifo(path, 0600), 0);
    assert_false(text_file_read(path, 100, &bytes, &size, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    assert_non_null(strstr(err.message, "is a pipe (FIFO), not a file"));
    unlink(path);
}

static void expect_refused(const char *name, int32_t most, const char *words)
{
    Error err = {0};
    char *bytes = NULL;
    int32_t size = 0;
    assert_false(text_file_read(name, most, &bytes, &size, &err));
    assert_int_equal(err.code, ERROR_INPUT);
    assert_null(bytes);
    if (!strstr(err.message, words)) fail_msg("`%s` lacks `%s`", err.message, words);
}

TEST(test_refused)
{
    write_bytes(10);
    expect_refused(path, 9, "more than the 9 bytes");
    expect_refused(folder, 9, "is a folder");
    expect_refused("/proc/none", 9, "No such file");
}

TEST(test_memory)
{
    int64_t live = memory_counters().live, k = 0;
    write_bytes(20000);
    for (bool done = false; !done; k++) {
        Error err = {0};
        char *bytes = NULL;
        int32_t size = 0;
        memory_fail_after(k);
        done = text_file_read(path, 20000, &bytes, &size, &err);
        memory_fail_after(-1);
        assert_true(done || err.code == ERROR_MEMORY);
        memory_free(bytes);
        assert_int_equal(memory_counters().live, live);
    }
    assert_int_equal(k, 5);   // 4096 bytes, doubled three times, and the one that went well
}

FIXTURE(make_folder)
{
    if (!mkdtemp(folder)) return -1;
    snprintf(path, sizeof path, "%s/text", folder);
    return 0;
}

FIXTURE(remove_folder)
{
    unlink(path);
    return rmdir(folder);
}

GROUP_BETWEEN(make_folder, remove_folder);
