// SPDX-License-Identifier: GPL-2.0-or-later
// One process at a time at some work, by a lock on a file. The lock is
// flock's: it belongs to the open file and ends with the process, however that ends. The file of a
// process that was killed stays; it blocks nobody, and the next one that takes the lock removes it.
// Called by io/cache/store and run/result/result_folder; part_file shares file_lock_try and
// file_is_named.
//
//   take -> (the work) -> release     take also gives up: after its limit, or where the folder
//                                     cannot be written to
#ifndef AMONTONS_IO_FILES_FILE_LOCK_H
#define AMONTONS_IO_FILES_FILE_LOCK_H

#include <limits.h>
#include <stdbool.h>

typedef enum LockTry { LOCK_OURS, LOCK_BUSY, LOCK_NONE } LockTry;

// Locks the open file without waiting. LOCK_BUSY: another process holds it. LOCK_NONE: the file
// system has no locks (Lustre without `-o flock`, NFS without lockd, ...): the work goes on
// without.
LockTry file_lock_try(int descriptor);

typedef struct FileLock {
    bool held;   // false: zeroed, given up or released
    bool alone;   // false: the file system has no locks, and others may hold it, too
    bool busy;   // given up, as another process held it to the end
    int descriptor;   // valid while held
    char path[PATH_MAX + 64];
} FileLock;

// Waits until no other process holds the lock of the file `path`, at most `seconds`; true: it is
// ours (alone). false is no error: errno tells why, and `busy`; the caller may work without a lock.
bool file_lock_take(FileLock *lock, const char *path, double seconds);
// The warning that belongs to a lock that is held and not alone, once in a process; else NULL.
const char *file_lock_warning(const FileLock *lock);
void file_lock_release(FileLock *lock);   // removes the file; fine when not held

// True if `name` is still the name of the file behind `descriptor`: it may have been removed,
// renamed or replaced between opening and locking.
bool file_is_named(const char *name, int descriptor);

#endif
