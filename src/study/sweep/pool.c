// SPDX-License-Identifier: GPL-2.0-or-later
// Computes pending points, each in a child process, so that a crash costs one point only. A pipe
// from each child carries the message that could not be written to run.json; when the pipe closes,
// the child has ended.
#include "study/sweep/pool.h"

#include "base/clock.h"
#include "base/memory.h"
#include "study/sweep/tally.h"

#include <errno.h>
#include <poll.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

enum { JOBS_MAX = 1024, WAKE_MS = 200 };   // how often the stop flag is looked at

typedef struct Worker {
    pid_t process;   // 0: none
    int pipe;   // its end for reading
    int32_t point;
    double started;   // wall clock, s
    char message[ERROR_MESSAGE_SIZE];
    size_t length;   // of the message so far
} Worker;

// Processes, not threads: the libraries below keep states of their own (gmsh, HDF5), and a crash
// must not take its neighbours along.
typedef struct Pool {
    Sweep *sweep;
    int32_t size;   // workers at a time
    Worker *workers;   // [size]; owned
    struct pollfd *polled;   // [size]; owned
    int32_t next;   // point to look at for the next worker
} Pool;

// --- in the child -------------------------------------------------------------------------------

// Never returns. The child dies with its parent, and by the signals that the parent handles.
static void be_child(const Sweep *sweep, int32_t point, int pipe, pid_t parent)
{
    Error err = {0};
    signal(SIGTERM, SIG_DFL);
    signal(SIGINT, SIG_IGN);   // of the terminal: the parent decides
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(1);
    bool done = point_run(sweep, point, &err);
    size_t length = strlen(err.message);
    if (!done && write(pipe, err.message, length) != (ssize_t)length) _exit(1);
    _exit(0);
}

// --- in the parent ------------------------------------------------------------------------------

// The child's pid is compared with ours after the fork (be_child): a parent that died in between
// would leave it without one.
static bool start_worker(Pool *pool, Worker *worker, int32_t point, Error *err)
{
    int ends[2] = {-1, -1};
    pid_t parent = getpid();
    if (pipe(ends) != 0) FAIL(err, ERROR_FILE, "cannot open a pipe: %s", strerror(errno));
    *worker = (Worker){.point = point, .started = clock_seconds(), .pipe = ends[0]};
    worker->process = fork();
    if (worker->process == 0) {
        close(ends[0]);
        be_child(pool->sweep, point, ends[1], parent);
    }
    close(ends[1]);
    if (worker->process < 0) {
        int cause = errno;
        worker->process = 0;
        close(ends[0]);
        FAIL(err, ERROR_FILE, "cannot start a process: %s", strerror(cause));
    }
cleanup:
    return error_is_clean(err);
}

// Takes what the child left, or else why it left nothing. ending: as waitpid has it.
static bool note_result(Pool *pool, Worker *worker, int ending, Error *err)
{
    const char *failure = "crashed";
    char message[ERROR_MESSAGE_SIZE];
    double seconds = clock_seconds() - worker->started;
    bool left = false;
    TRY(sweep_take_ended(pool->sweep, worker->point, seconds, &left, err));
    if (left) goto cleanup;
    if (WIFSIGNALED(ending)) {
        snprintf(message, sizeof message, "the process ended by signal %d (%s)", WTERMSIG(ending),
                 strsignal(WTERMSIG(ending)));
    } else if (*worker->message) {
        failure = "not begun";
        snprintf(message, sizeof message, "%s", worker->message);
    } else {
        snprintf(message, sizeof message, "the process ended with status %d, without a word",
                 WEXITSTATUS(ending));
    }
    TRY(sweep_take_lost(pool->sweep, worker->point, seconds, failure, message, err));
cleanup:
    return error_is_clean(err);
}

// Waits for the child and frees its worker. The status as waitpid has it.
static int reap(Worker *worker)
{
    int ending = 0;
    while (waitpid(worker->process, &ending, 0) < 0 && errno == EINTR) continue;
    close(worker->pipe);
    worker->process = 0;
    return ending;
}

// Reads what the child wrote; when its end of the pipe is closed, the child has ended.
static bool read_worker(Pool *pool, Worker *worker, Error *err)
{
    char bytes[256];
    ssize_t count = read(worker->pipe, bytes, sizeof bytes);
    if (count < 0 && errno == EINTR) return true;
    if (count <= 0) return note_result(pool, worker, reap(worker), err);
    size_t room = sizeof worker->message - 1 - worker->length;
    size_t taken = (size_t)count < room ? (size_t)count : room;
    memcpy(worker->message + worker->length, bytes, taken);
    worker->length += taken;
    return true;
}

// Gives every idle worker the next pending point.
static bool fill_workers(Pool *pool, Error *err)
{
    Sweep *sweep = pool->sweep;
    for (int32_t k = 0; k < pool->size; k++) {
        if (pool->workers[k].process) continue;
        while (pool->next < sweep->study.point_count && !sweep_is_waiting(sweep, pool->next))
            pool->next++;
        if (pool->next == sweep->study.point_count) break;
        TRY(start_worker(pool, &pool->workers[k], pool->next, err));
        pool->next++;
    }
cleanup:
    return error_is_clean(err);
}

// Waits for output or the end of any worker. *running: how many there are.
static bool read_workers(Pool *pool, int32_t *running, Error *err)
{
    *running = 0;
    for (int32_t k = 0; k < pool->size; k++) {
        const Worker *worker = &pool->workers[k];
        pool->polled[k] =
            (struct pollfd){.fd = worker->process ? worker->pipe : -1, .events = POLLIN};
        *running += worker->process != 0;
    }
    if (*running == 0) return true;
    if (poll(pool->polled, (nfds_t)pool->size, WAKE_MS) <= 0) return true;
    for (int32_t k = 0; k < pool->size; k++)
        if (pool->polled[k].revents) TRY(read_worker(pool, &pool->workers[k], err));
cleanup:
    return error_is_clean(err);
}

// A point that was written before the signal came is finished like any other.
static void end_workers(Pool *pool)
{
    for (int32_t k = 0; k < pool->size; k++) {
        Error ignored = {0};   // the caller tells why the pool ends
        Worker *worker = &pool->workers[k];
        bool left = false;
        if (!worker->process) continue;
        kill(worker->process, SIGTERM);
        reap(worker);
        sweep_take_ended(pool->sweep, worker->point, clock_seconds() - worker->started, &left,
                         &ignored);
    }
}

// Children are watched by poll, not by signals: a pipe closes however its child ends.
bool pool_run(Sweep *sweep, Error *err)
{
    int32_t cores = (int32_t)sysconf(_SC_NPROCESSORS_ONLN), running = 0;
    Pool pool = {.sweep = sweep, .size = sweep->options->jobs};
    if (pool.size < 1) pool.size = cores > 0 ? cores : 1;
    if (pool.size > JOBS_MAX) pool.size = JOBS_MAX;
    TRY((pool.workers = NEW_ARRAY(Worker, pool.size, err)));
    TRY((pool.polled = NEW_ARRAY(struct pollfd, pool.size, err)));
    do {
        TRY(sweep_check_stop(sweep, err));
        TRY(fill_workers(&pool, err));
        TRY(read_workers(&pool, &running, err));
    } while (running > 0);
cleanup:
    if (pool.workers) end_workers(&pool);
    memory_free(pool.workers);
    memory_free(pool.polled);
    return error_is_clean(err);
}
