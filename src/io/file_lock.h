// SPDX-License-Identifier: GPL-2.0-or-later
// One process at a time at some work, told by a lock on a file that is there only meanwhile. The
// lock is flock's: it belongs to the open file and ends with the process, however that ends, so
// that nothing has to be cleared up after a kill. Called by model/basis_cache and
// run/result_folder; part_file shares
// file_is_named.
//
//   take -> (the work) -> release     take also gives up: after its limit, where the folder cannot
//                                     be written to, or on a file system without locks
#ifndef AMONTONS_IO_FILE_LOCK_H
#define AMONTONS_IO_FILE_LOCK_H

#include <limits.h>
#include <stdbool.h>

typedef struct FileLock {
    bool held;   // false: zeroed, given up or released
    bool busy;   // given up, as another process held it to the end
    int descriptor;   // valid while held
    char path[PATH_MAX + 64];
} FileLock;

// Waits until no other process holds the lock of the file `path`, at most `seconds`; true: it is
// ours. Never an error: who is told false does the work without one.
bool file_lock_take(FileLock *lock, const char *path, double seconds);
void file_lock_release(FileLock *lock);   // removes the file; fine when not held

// Whether the name still leads to the file behind `descriptor`: it may have been removed, renamed
// or replaced between our opening and our locking it.
bool file_is_named(const char *name, int descriptor);

#endif
