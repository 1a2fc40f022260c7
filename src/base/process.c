// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/process.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/wait.h>

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
