// SPDX-License-Identifier: GPL-2.0-or-later
// Other programs: what they say, how they end, and that there may be none.
#include "base/child_program.h"

#include "cases.h"

#include <signal.h>
#include <string.h>

static int shell(const char *script, char *output, size_t size)
{
    const char *const words[] = {"sh", "-c", script, NULL};
    Error err = {0};
    int status = -1;
    if (!child_program_run(words, output, size, &status, &err)) fail_msg("%s", err.message);
    return status;
}

TEST(takes_what_is_said)
{
    char output[40];
    assert_int_equal(shell("echo one; echo two >&2; exit 3", output, sizeof output), 3);
    assert_string_equal(output, "one\ntwo\n");
    assert_int_equal(shell("read word || echo nothing to read", output, sizeof output), 0);
    assert_string_equal(output, "nothing to read\n");
    assert_int_equal(shell("kill -TERM $$", output, sizeof output), 128 + SIGTERM);
    assert_string_equal(output, "");
}

// A pipe holds 64 kB: who does not read on waits for ever.
TEST(reads_to_the_end)
{
    char output[5];
    assert_int_equal(shell("head -c 300000 /dev/zero | tr '\\0' x", output, sizeof output), 0);
    assert_string_equal(output, "xxxx");
}

TEST(says_which_program_is_missing)
{
    const char *const words[] = {"amontons-no-such-program", NULL};
    char output[10];
    int status = 0;
    Error err = {0};
    assert_false(child_program_run(words, output, sizeof output, &status, &err));
    assert_int_equal(err.code, ERROR_LIBRARY);
    assert_non_null(strstr(err.message, "`amontons-no-such-program`: No such file"));
}

// A failed sbatch counted as done, its words as the job.
TEST(says_that_nobody_knows_how_it_ended)
{
    const char *const words[] = {"sh", "-c", "echo ran; exit 3", NULL};
    char output[10] = "?";
    int status = -1;
    Error err = {0};
    signal(SIGCHLD, SIG_IGN);
    assert_false(child_program_run(words, output, sizeof output, &status, &err));
    signal(SIGCHLD, SIG_DFL);
    assert_int_equal(err.code, ERROR_LIBRARY);
    assert_non_null(strstr(err.message, "`sh` ended in a way that nobody can say: SIGCHLD"));
    assert_int_equal(status, -1);
}
