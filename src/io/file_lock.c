// SPDX-License-Identifier: GPL-2.0-or-later
// The holder removes the file before it releases the lock. A process that waited for it then holds
// the lock of a file without a name, which guards nothing: it opens the name again.
#include "io/file_lock.h"

#include "base/clock.h"

#include <errno.h>
#include <fcntl.h>
#include <stdatomic.h>
#include <stdint.h>
#include <stdio.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

static const struct timespec PAUSE = {.tv_nsec = 10000000};   // between two tries: 10 ms

// What a signal handler can reach. A lock that finds no place is one whose file stays.
enum { HELD_MAX = 8 };
static _Atomic(FileLock *) held_locks[HELD_MAX];

// From the one to the other, in the first place that fits; NULL: no lock.
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
    return stat(name, &named) == 0 && fstat(descriptor, &opened) == 0 &&
           named.st_dev == opened.st_dev && named.st_ino == opened.st_ino;
}

// Tried again and again, as flock itself cannot wait for a limited time.
bool file_lock_take(FileLock *lock, const char *path, double seconds)
{
    double until = clock_seconds() + seconds;
    *lock = (FileLock){0};
    if (snprintf(lock->path, sizeof lock->path, "%s", path) >= (int)sizeof lock->path) return false;
    for (;;) {
        lock->descriptor = open(path, O_RDWR | O_CREAT | O_CLOEXEC, 0666);
        if (lock->descriptor < 0) return false;
        int cause = flock(lock->descriptor, LOCK_EX | LOCK_NB) == 0 ? 0 : errno;
        lock->held = cause == 0 && file_is_named(path, lock->descriptor);
        if (lock->held) {
            lock->busy = false;
            lock->owner = getpid();
            exchange_held(NULL, lock);
            return true;
        }
        close(lock->descriptor);
        if (cause == 0 || cause == EINTR) continue;
        lock->busy = cause == EWOULDBLOCK;
        if (!lock->busy || clock_seconds() >= until) return false;
        nanosleep(&PAUSE, NULL);
    }
}

void file_lock_release(FileLock *lock)
{
    if (!lock->held) return;
    exchange_held(lock, NULL);
    unlink(lock->path);
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
