// SPDX-License-Identifier: GPL-2.0-or-later
// fork without exec: a few tenths of a millisecond, and the child has all that it needs. The pipe
// carries the reply and at its end the Error; a reply without one is that of a crash.
#include "base/child_process.h"

#include "base/clock.h"
#include "base/memory.h"
#include "base/process.h"
#include "base/shut_in.h"
#include "base/system.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <poll.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

enum { FIRST_BYTES = 1 << 16, WAKE_MS = 100 };
enum { LOADER_FAILED = 127 };   // exit status where a library lacks a function that is called

static atomic_bool by_children;   // of the whole process: whether it may fork is a matter of that

void child_use(bool use)
{
    by_children = use;
}

bool child_is_wanted(void)
{
    const char *users = getenv("AMONTONS_APART");
    return users ? *users : by_children;
}

// --- in the child -------------------------------------------------------------------------------

static rlim_t bytes_allowed(void)
{
    return (rlim_t)sysconf(_SC_PHYS_PAGES) * (rlim_t)sysconf(_SC_PAGESIZE) / 4 * 3;
}

// A limit that the user has set lower stays.
static void limit(__rlimit_resource_t resource, rlim_t most)
{
    struct rlimit now;
    if (getrlimit(resource, &now) != 0 || now.rlim_cur <= most) return;
    now.rlim_cur = most;
    setrlimit(resource, &now);
}

void child_allow(int32_t seconds)
{
    struct rlimit now;
    if (getrlimit(RLIMIT_CPU, &now) != 0) return;
    now.rlim_cur = now.rlim_max < (rlim_t)seconds ? now.rlim_max : (rlim_t)seconds;
    setrlimit(RLIMIT_CPU, &now);
}

// Never returns, and leaves the parent's streams and exit handlers alone.
static void be_child(const ChildWork *work, int pipe, pid_t parent)
{
    Error err = {0};
    if (work->shut_in) {
        // Closes what else is open: a child that was misled has nothing to write to but the pipe
        // and, for the words of a crash, standard error. work->kept stays, too.
        int nothing = open("/dev/null", O_RDWR), kept = work->kept;
        int low = kept < 1 || pipe < kept ? pipe : kept, high = kept > pipe ? kept : pipe;
        if (nothing >= 0) {
            dup2(nothing, STDIN_FILENO);
            dup2(nothing, STDOUT_FILENO);
        }
        shut_in_close(STDERR_FILENO + 1, low - 1);
        shut_in_close(low + 1, high - 1);
        shut_in_close(high + 1, INT_MAX);
    }
    FILE *reply = fdopen(pipe, "wb");
    if (!work->stop) {
        signal(SIGTERM, SIG_DFL);
        signal(SIGINT, SIG_DFL);
    }
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (!reply || getppid() != parent) _exit(1);
    limit(RLIMIT_CORE, 0);
    limit(RLIMIT_CPU, (rlim_t)work->seconds);
    limit(RLIMIT_AS, (rlim_t)system_address_space() + bytes_allowed());
    if (work->shut_in) shut_in();
    work->read(work->context, reply, &err);
    err.file = NULL;   // may lie in a module that the parent has not opened
    bool written = fwrite(&err, sizeof err, 1, reply) == 1 && fflush(reply) == 0;
    _exit(written ? 0 : 1);
}

// --- in the parent ------------------------------------------------------------------------------

// Reads to the end of the pipe. Memory may be short: the rest is then not read, and the child ends.
// The pipe may be open in a process that the child has started, so its end is not waited for when
// the time is over.
static bool take_all(const ChildWork *work, pid_t child, int pipe, ChildReply *reply, Error *err)
{
    int64_t room = FIRST_BYTES;
    bool told = !work->stop;   // Ctrl-C comes to both; kill to one
    const ChildWatch *watch = work->watch;
    struct pollfd ready = {.fd = pipe, .events = POLLIN};
    double started = clock_seconds();
    if (!(reply->bytes = memory_bytes(room, err))) return false;
    for (;;) {
        if (!told && *work->stop) told = kill(child, SIGTERM) == 0;
        if (work->seconds_waited && clock_seconds() - started > work->seconds_waited) {
            kill(child, SIGKILL);
            return REFUSE(err, "%s: %s was still reading it after %d seconds, and was ended; %s",
                          work->path, work->reader, work->seconds_waited, work->advice);
        }
        if (watch && !watch->goes_on(watch->self, err)) {
            kill(child, SIGKILL);
            return false;
        }
        // A signal that came before it waited does not interrupt it.
        if (poll(&ready, 1, told && !work->seconds_waited && !watch ? -1 : WAKE_MS) <= 0) continue;
        if (reply->size == room) {
            if (!memory_resize(&reply->bytes, room, 2 * room, 1, err)) return false;
            room *= 2;
        }
        ssize_t count = read(pipe, reply->bytes + reply->size, (size_t)(room - reply->size));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) break;
        reply->size += count;
    }
    return error_is_clean(err);
}

// Text that the streams of this process hold is written before: the child has a copy of it.
bool child_read(const ChildWork *work, ChildReply *reply, Error *err)
{
    int ends[2] = {-1, -1};
    struct rusage used = {0};
    pid_t parent = getpid();
    *reply = (ChildReply){0};
    fflush(NULL);
    if (pipe(ends) != 0) FAIL(err, ERROR_FILE, "cannot open a pipe: %s", strerror(errno));
    pid_t child = fork();
    if (child == 0) {
        close(ends[0]);
        be_child(work, ends[1], parent);
    }
    int cause = errno;
    close(ends[1]);
    if (child > 0) take_all(work, child, ends[0], reply, err);
    close(ends[0]);
    if (child < 0) FAIL(err, ERROR_FILE, "cannot start a process: %s", strerror(cause));
    int ending = process_wait(child, &used);
    TRY(error_is_clean(err));

    // Its answer, or why there is none.
    int number = WIFSIGNALED(ending) ? WTERMSIG(ending) : 0;
    if (ending == 0 && reply->size >= (int64_t)sizeof(Error)) {
        Error said;   // the child's own error, at the end of the reply
        reply->size -= (int64_t)sizeof said;
        memcpy(&said, reply->bytes + reply->size, sizeof said);
        said.message[sizeof said.message - 1] = 0;
        if (said.code != ERROR_NONE)
            error_set(err, said.code, __FILE__, __LINE__, "%s", said.message);
    } else if (ending == PROCESS_LOST) {
        char words[200];
        process_describe(ending, words, sizeof words);
        FAIL(err, ERROR_LIBRARY, "%s: the process in which %s reads it ended %s", work->path,
             work->reader, words);
    } else if (number == SIGXCPU) {
        FAIL(err, ERROR_INPUT, "%s: %s had not read it after %ld seconds; %s", work->path,
             work->reader, (long)(used.ru_utime.tv_sec + used.ru_stime.tv_sec + 1), work->advice);
    } else if (number == SIGKILL ||
               (double)used.ru_maxrss > 0.8 * ((double)bytes_allowed() / 1024)) {
        FAIL(err, ERROR_INPUT, "%s: %s was ended while reading it, at %.1f GB of memory; %s",
             work->path, work->reader, (double)used.ru_maxrss / (1 << 20), work->advice);
    } else if (WIFEXITED(ending) && WEXITSTATUS(ending) == LOADER_FAILED) {
        FAIL(err, ERROR_LIBRARY,
             "%s: the libraries of %s do not fit each other (the loader says above what is "
             "missing): is another one first in LD_LIBRARY_PATH?",
             work->path, work->reader);
    } else {
        FAIL(err, ERROR_INPUT,
             "%s: %s crashes while reading it (%s): the file is damaged, or asks for what %s "
             "cannot make",
             work->path, work->reader, number ? strsignal(number) : "without a word", work->reader);
    }
cleanup:
    if (!error_is_clean(err)) child_destroy(reply);
    return error_is_clean(err);
}

bool child_do(const ChildWork *work, Error *err)
{
    ChildReply reply = {0};
    bool done = child_is_wanted() ? child_read(work, &reply, err)
                                  : work->read(work->context, NULL, err);
    child_destroy(&reply);
    return done;
}

void child_destroy(ChildReply *reply)
{
    memory_free(reply->bytes);
    *reply = (ChildReply){0};
}
