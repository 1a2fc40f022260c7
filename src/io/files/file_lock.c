// SPDX-License-Identifier: GPL-2.0-or-later
// The holder removes the file before it releases the lock. A process that waited for it then holds
// the lock of a file without a name, which guards nothing: it opens the name again.
#include "io/files/file_lock.h"

#include "base/clock.h"
#include "io/files/open_file.h"

#include <errno.h>
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

static const struct timespec PAUSE = {.tv_nsec = 10000000};   // between two tries: 10 ms

// Locks that a signal handler can reach. The file of a lock that finds no place here stays.
enum { HELD_MAX = 8 };
static _Atomic(FileLock *) held_locks[HELD_MAX];

// Replaces the one by the other, in the first place that fits; NULL: no lock.
static void exchange_held(FileLock *from, FileLock *to)
{
    for (int32_t k = 0; k < HELD_MAX; k++) {
        FileLock *found = from;
        if (atomic_compare_exchange_strong(&held_locks[k], &found, to)) return;
    }
}

bool file_is_named(const char *name, int descriptor)
{
    struct stat named, opened;
    return lstat(name, &named) == 0 && fstat(descriptor, &opened) == 0 &&
           named.st_dev == opened.st_dev && named.st_ino == opened.st_ino;
}

// Until signals are let in again a handler finds the lock's file and its place among the held ones,
// or neither.
static void hold_signals(sigset_t *before)
{
    sigset_t all;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, before);
}

LockTry file_lock_try(int descriptor)
{
    while (flock(descriptor, LOCK_EX | LOCK_NB) != 0)
        if (errno != EINTR) return errno == EWOULDBLOCK ? LOCK_BUSY : LOCK_NONE;
    return LOCK_OURS;
}

// Tried again and again, as flock itself cannot wait for a limited time.
bool file_lock_take(FileLock *lock, const char *path, double seconds)
{
    double until = clock_seconds() + seconds;
    *lock = (FileLock){0};
    if (snprintf(lock->path, sizeof lock->path, "%s", path) >= (int)sizeof lock->path) return false;
    for (;;) {
        // One try: `held` only where the file still has its name.
        sigset_t before;
        char why[OPEN_WHY_SIZE];
        hold_signals(&before);
        lock->descriptor = open_to_write(path, OPEN_KEPT, why);
        int cause = errno;
        LockTry got = lock->descriptor >= 0 ? file_lock_try(lock->descriptor) : LOCK_NONE;
        lock->busy = got == LOCK_BUSY;
        lock->alone = got == LOCK_OURS;
        lock->held = lock->descriptor >= 0 && !lock->busy && file_is_named(path, lock->descriptor);
        if (lock->held) {
            lock->owner = getpid();
            exchange_held(NULL, lock);
        } else if (lock->descriptor >= 0) {
            close(lock->descriptor);
        }
        pthread_sigmask(SIG_SETMASK, &before, NULL);
        errno = cause;

        if (lock->descriptor < 0) return false;
        if (lock->held) return true;
        if (!lock->busy) continue;   // its holder removed the file meanwhile
        if (clock_seconds() >= until) return false;
        nanosleep(&PAUSE, NULL);
    }
}

static atomic_bool warned;   // also by a sweep, for its points, which are processes of its own

const char *file_lock_warning(const FileLock *lock)
{
    if (!lock->held || lock->alone || atomic_exchange(&warned, true)) return NULL;
    return "the file system of the result's folder has no locks: nothing keeps a second "
           "computation out of it meanwhile";
}

// A signal handler finds a whole lock at any moment: `to` is filled before it takes the place of
// `from`, which is emptied afterwards.
void file_lock_move(FileLock *from, FileLock *to)
{
    *to = *from;
    exchange_held(from, to);
    *from = (FileLock){0};
}

void file_lock_release(FileLock *lock)
{
    sigset_t before;
    if (!lock->held) return;
    hold_signals(&before);
    exchange_held(lock, NULL);
    unlink(lock->path);
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    close(lock->descriptor);
    lock->held = false;
}

void file_locks_let_go(void)
{
    for (int32_t k = 0; k < HELD_MAX; k++) {
        const FileLock *lock = atomic_load(&held_locks[k]);
        if (lock && lock->owner == getpid()) unlink(lock->path);
    }
}
