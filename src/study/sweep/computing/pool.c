// SPDX-License-Identifier: GPL-2.0-or-later
// Computes pending points in child processes, each of which computes one point after the other: to
// start a process costs as much as a tenth of a small point. A crash costs one point only: the next
// one gets a new process. What a child is to compute it reads from a socket; there it says that a
// point has ended, with the message that could not be written to run.json. When the socket closes,
// the child has ended.
#include "study/sweep/computing/point.h"

#include "base/clock.h"
#include "base/memory.h"
#include "base/parallel.h"
#include "base/process.h"
#include "base/system.h"
#include "base/transfer.h"

#include <errno.h>
#include <malloc.h>
#include <poll.h>
#include <string.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <unistd.h>

enum {
    JOBS_MAX = 1024,
    WAKE_MS = 200,   // how often the stop flag is looked at
    MEMORY_KEPT = 1 << 26,   // bytes
    POINTS_EACH = 256   // of a child: whatever a library does not free goes with it
};

typedef struct PoolChild {
    pid_t process;   // 0: none
    int socket;   // our end
    int32_t point;   // under way; -1: none
    int32_t given;   // points so far
    double started;   // the point; wall clock, s
} PoolChild;

// A point has ended; `size` bytes of its report follow.
typedef struct Reply {
    char message[ERROR_MESSAGE_SIZE];   // empty: it ended well, or its report says how
    ErrorCode code;   // of the message
    int32_t size;   // 0: its report is run.json, or there is none
} Reply;

// Processes, not threads: the libraries below keep states of their own (gmsh, HDF5), and a crash
// must not take its neighbours along.
typedef struct Pool {
    Sweep *sweep;
    int32_t size;   // children at a time
    PoolChild *children;   // [size]; owned
    int32_t next, step;   // point to look at for the next child; to the one behind it
} Pool;

// Starts a child process, which computes the points that it reads from its socket until that
// closes. Streams are flushed before the fork, as the child has a copy of them.
static bool start_child(Pool *pool, PoolChild *child, Error *err)
{
    int ends[2] = {-1, -1};
    pid_t parent = getpid();
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0)
        return FAULT(err, ERROR_FILE, "cannot open a socket: %s", strerror(errno));
    fflush(NULL);
    *child = (PoolChild){.process = fork(), .socket = ends[0], .point = -1};
    if (child->process == 0) {
        // This is the child, which never returns. SIGTERM ends it, and so does the end of its
        // parent.
        int32_t point;
        close(ends[0]);
        signal(SIGTERM, SIG_DFL);
        signal(SIGINT, SIG_IGN);   // of the terminal: the parent decides
        prctl(PR_SET_PDEATHSIG, SIGKILL);

        // A parent that has died since the fork has sent no signal; the child then has another one.
        if (getppid() != parent) _exit(1);
        parallel_share(pool->size);
        mallopt(M_TRIM_THRESHOLD, MEMORY_KEPT);   // the next point needs what the last gave back
        mallopt(M_MMAP_THRESHOLD, MEMORY_KEPT);
        while (transfer_read(ends[1], &point, sizeof point, -1) == sizeof point) {
            Error failure = {0};
            Reply reply = {0};
            char *report = NULL;
            if (!point_run(pool->sweep, point, &report, &failure)) {
                memcpy(reply.message, failure.message, sizeof reply.message);
                reply.code = failure.code;
            }
            reply.size = report ? (int32_t)strlen(report) : 0;
            bool sent = transfer_write(ends[1], &reply, sizeof reply, -1) == 0 &&
                        transfer_write(ends[1], report, reply.size, -1) == 0;
            memory_free(report);
            if (!sent) _exit(1);
        }
        _exit(0);
    }
    close(ends[1]);
    if (child->process < 0) {
        int cause = errno;
        child->process = 0;
        close(ends[0]);
        return FAULT(err, ERROR_FILE, "cannot start a process: %s", strerror(cause));
    }
    return true;
}

// Waits for the child, which ends by itself once it has nothing to read, and frees its place. The
// status as process_wait has it.
static int reap(PoolChild *child)
{
    shutdown(child->socket, SHUT_WR);   // also where another child has a copy of it
    int ending = process_wait(child->process, NULL);
    close(child->socket);
    child->process = 0;
    return ending;
}

// Gives an idle child the next pending point; without one it stays idle. A child that cannot be
// written to has died: that shows when it is read.
static bool give_point(Pool *pool, PoolChild *child, Error *err)
{
    Sweep *sweep = pool->sweep;
    while (pool->next < sweep->study.point_count && !sweep_is_waiting(sweep, pool->next))
        pool->next++;
    if (pool->next >= sweep->study.point_count) return true;
    if (child->process && child->given == POINTS_EACH) reap(child);
    if (!child->process && !start_child(pool, child, err)) return false;
    child->point = pool->next;
    pool->next += pool->step;
    child->given++;
    child->started = clock_seconds();
    send(child->socket, &child->point, sizeof child->point, MSG_NOSIGNAL);
    return true;
}

// Takes the reply of a child whose socket has something to read, and what its point left, or else
// records why that left nothing: the message of its child, or how that ended. The next point is
// handed out before the result of the last is looked at.
static bool read_child(Pool *pool, PoolChild *child, Error *err)
{
    Reply reply = {0};
    PoolChild before = *child;
    Error unable = {0};
    char *report = NULL, message[ERROR_MESSAGE_SIZE], how[200];
    int ending = 0;
    bool left = false;
    bool whole = transfer_read(child->socket, &reply, sizeof reply, -1) == sizeof reply;
    if (whole && reply.size > 0) {
        report = memory_array((int64_t)reply.size + 1, 1, err);
        whole = report && transfer_read(child->socket, report, reply.size, -1) == reply.size;
    }
    if (whole)
        child->point = -1;
    else
        ending = reap(child);   // the child has ended
    if (before.point < 0) goto cleanup;
    give_point(pool, child, &unable);
    if (whole && report) TRY(point_keep(pool->sweep, before.point, report, err));

    double seconds = clock_seconds() - before.started;
    process_describe(ending, how, sizeof how);
    TRY(sweep_take_ended(pool->sweep, before.point, seconds, &left, err));
    if (!left) {
        const char *said = reply.message, *failure = *said ? "not begun" : "crashed";
        if (*said && (reply.code == ERROR_FILE || reply.code == ERROR_MEMORY))
            failure = amontons_error_name(reply.code);   // the machine's, not the point's
        if (*said)
            snprintf(message, sizeof message, "%s", said);
        else
            snprintf(message, sizeof message, "the process ended %s, without a word", how);
        TRY(sweep_take_lost(pool->sweep, before.point, seconds, failure, message, err));
    }
    if (!error_is_clean(&unable)) *err = unable;
cleanup:
    memory_free(report);
    return error_is_clean(err);
}

// Children are watched by poll, not by signals: a pipe closes however its child ends.
bool pool_run(Sweep *sweep, int32_t jobs, int32_t step, Error *err)
{
    int32_t cores = (int32_t)sysconf(_SC_NPROCESSORS_ONLN), running = 0;
    Pool pool = {.sweep = sweep, .size = jobs, .step = step};
    struct pollfd *polled = NULL;   // [size]
    if (pool.size < 1) pool.size = cores > 0 ? cores : 1;
    if (pool.size > JOBS_MAX) pool.size = JOBS_MAX;
    TRY((pool.children = NEW_ARRAY(PoolChild, pool.size, err)));
    TRY((polled = NEW_ARRAY(struct pollfd, pool.size, err)));
    do {
        TRY(sweep_check_stop(sweep, err));
        running = 0;
        for (int32_t k = 0; k < pool.size; k++) {
            PoolChild *child = &pool.children[k];
            if (!child->process || child->point < 0) TRY(give_point(&pool, child, err));
        }

        // Output, or the end, of any child.
        for (int32_t k = 0; k < pool.size; k++) {
            const PoolChild *child = &pool.children[k];
            polled[k] =
                (struct pollfd){.fd = child->process ? child->socket : -1, .events = POLLIN};
            running += child->process != 0 && child->point >= 0;
        }
        if (running == 0 || poll(polled, (nfds_t)pool.size, WAKE_MS) <= 0) continue;
        for (int32_t k = 0; k < pool.size; k++)
            if (polled[k].revents) TRY(read_child(&pool, &pool.children[k], err));
    } while (running > 0);
cleanup:
    // A point that was written before the signal came is finished like any other.
    for (int32_t k = 0; pool.children && k < pool.size; k++) {
        Error ignored = {0};   // the caller tells why the pool ends
        PoolChild *child = &pool.children[k];
        bool left = false;
        if (!child->process) continue;
        kill(child->process, SIGTERM);
        reap(child);
        if (child->point >= 0)
            sweep_take_ended(sweep, child->point, clock_seconds() - child->started, &left,
                             &ignored);
    }
    memory_free_all(pool.children, polled);
    return error_is_clean(err);
}
