// SPDX-License-Identifier: GPL-2.0-or-later
// How processes end, and where nobody could say; other programs: what they say, and that there may
// be none.
#include "base/process.h"

#include "cases.h"

#include <signal.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

static pid_t start(int status, int number)
{
    pid_t child = fork();
    if (child != 0) return child;
    if (number) raise(number);
    _exit(status);
}

static void assert_ended(int ending, const char *words)
{
    char found[200];
    process_describe(ending, found, sizeof found);
    assert_string_equal(found, words);
}

TEST(says_how_it_ended)
{
    struct rusage used = {0};
    assert_ended(process_wait(start(0, 0), NULL), "with status 0");
    assert_ended(process_wait(start(3, 0), NULL), "with status 3");
    assert_ended(process_wait(start(0, SIGKILL), &used), "by signal 9 (Killed)");
    assert_true(used.ru_maxrss > 0);
}

TEST(says_that_nobody_knows)
{
    pid_t child = start(0, 0);
    assert_int_equal(waitpid(child, NULL, 0), child);   // as a host may do
    assert_int_equal(process_wait(child, NULL), PROCESS_LOST);
    signal(SIGCHLD, SIG_IGN);
    assert_int_equal(process_wait(start(0, 0), NULL), PROCESS_LOST);
    signal(SIGCHLD, SIG_DFL);
    char words[200];
    process_describe(PROCESS_LOST, words, sizeof words);
    assert_non_null(strstr(words, "SIGCHLD is ignored"));
}

// --- other programs -----------------------------------------------------------------------------

static int shell(const char *script, char *output, size_t size)
{
    const char *const words[] = {"sh", "-c", script, NULL};
    Error err = {0};
    int status = -1;
    if (!process_run(words, output, size, &status, &err)) fail_msg("%s", err.message);
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
    assert_false(process_run(words, output, sizeof output, &status, &err));
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
    assert_false(process_run(words, output, sizeof output, &status, &err));
    signal(SIGCHLD, SIG_DFL);
    assert_int_equal(err.code, ERROR_LIBRARY);
    assert_non_null(strstr(err.message, "`sh` ended in a way that nobody can say: SIGCHLD"));
    assert_int_equal(status, -1);
}
