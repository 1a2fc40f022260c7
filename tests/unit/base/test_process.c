// SPDX-License-Identifier: GPL-2.0-or-later
// How processes end, and where nobody could say.
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
