// SPDX-License-Identifier: GPL-2.0-or-later
// The holder removes the file before it releases the lock. A process that waited for it then holds
// the lock of a file without a name, which guards nothing: it opens the name again.
#include "io/files/file_lock.h"

#include "base/clock.h"
#include "io/files/open_file.h"

#include <errno.h>
#include <stdatomic.h>
#include <stdio.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

static const struct timespec PAUSE = {.tv_nsec = 10000000};   // between two tries: 10 ms

bool file_is_named(const char *name, int descriptor)
{
    struct stat named, opened;
    return lstat(name, &named) == 0 && fstat(descriptor, &opened) == 0 &&
           named.st_dev == opened.st_dev && named.st_ino == opened.st_ino;
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
        char why[OPEN_WHY_SIZE];
        lock->descriptor = open_to_write(path, OPEN_KEPT, why);
        int cause = errno;
        LockTry got = lock->descriptor >= 0 ? file_lock_try(lock->descriptor) : LOCK_NONE;
        lock->busy = got == LOCK_BUSY;
        lock->alone = got == LOCK_OURS;
        lock->held = lock->descriptor >= 0 && !lock->busy && file_is_named(path, lock->descriptor);
        if (!lock->held && lock->descriptor >= 0) close(lock->descriptor);
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

void file_lock_release(FileLock *lock)
{
    if (!lock->held) return;
    unlink(lock->path);
    close(lock->descriptor);
    lock->held = false;
}
