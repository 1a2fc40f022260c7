// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/process.h"

#include <errno.h>
#include <fcntl.h>
#include <spawn.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

extern char **environ;

int process_wait(pid_t process, struct rusage *used)
{
    int ending = 0;
    pid_t ended;
    do ended = wait4(process, &ending, 0, used);
    while (ended < 0 && errno == EINTR);
    return ended == process ? ending : PROCESS_LOST;
}

void process_describe(int ending, char *words, size_t size)
{
    if (ending == PROCESS_LOST)
        snprintf(words, size,
                 "in a way that nobody can say: SIGCHLD is ignored in the process that started it, "
                 "or was waited for elsewhere in it");
    else if (WIFSIGNALED(ending))
        snprintf(words, size, "by signal %d (%s)", WTERMSIG(ending), strsignal(WTERMSIG(ending)));
    else
        snprintf(words, size, "with status %d", WEXITSTATUS(ending));
}

// A program that runs and fails is no error here: its status says so.
bool process_run(const char *const *words, char *output, size_t size, int *status, Error *err)
{
    int ends[2] = {-1, -1};
    pid_t process = 0;
    posix_spawn_file_actions_t files;
    posix_spawnattr_t attributes;
    *output = 0;
    if (pipe2(ends, O_CLOEXEC) != 0)
        return FAULT(err, ERROR_FILE, "cannot open a pipe: %s", strerror(errno));

    // Both outputs go into the pipe. posix_spawn in place of fork and exec: it does not copy the
    // page tables of a large process. In a process group of its own the program does not get the
    // terminal's Ctrl-C: sbatch, interrupted, could leave a job that nobody knows of.
    int cause = posix_spawn_file_actions_init(&files);
    if (cause == 0) {
        cause = posix_spawnattr_init(&attributes);
        if (cause == 0) {
            posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
            posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
            posix_spawn_file_actions_adddup2(&files, ends[1], STDOUT_FILENO);
            posix_spawn_file_actions_adddup2(&files, ends[1], STDERR_FILENO);
            // The words are not written to, although POSIX declares them without const.
            cause = posix_spawnp(&process, words[0], &files, &attributes, (char *const *)words,
                                 environ);
            posix_spawnattr_destroy(&attributes);
        }
        posix_spawn_file_actions_destroy(&files);
    }
    close(ends[1]);
    if (cause != 0) {
        close(ends[0]);
        return FAULT(err, ERROR_LIBRARY, "cannot run `%s`: %s", words[0], strerror(cause));
    }

    // Its output is read to the end, also what does not fit.
    size_t used = 0;
    char bytes[512];
    for (;;) {
        ssize_t count = read(ends[0], bytes, sizeof bytes);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) break;
        size_t taken = (size_t)count < size - 1 - used ? (size_t)count : size - 1 - used;
        memcpy(output + used, bytes, taken);
        used += taken;
    }
    output[used] = 0;
    close(ends[0]);
    int ending = process_wait(process, NULL);
    if (ending == PROCESS_LOST) {
        char words_of[200];
        process_describe(ending, words_of, sizeof words_of);
        return FAULT(err, ERROR_LIBRARY, "`%s` ended %s", words[0], words_of);
    }
    *status = WIFSIGNALED(ending) ? 128 + WTERMSIG(ending) : WEXITSTATUS(ending);
    return true;
}
