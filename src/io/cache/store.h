// SPDX-License-Identifier: GPL-2.0-or-later
// Keeps on disk what was made once and is wanted again, under a key that says what it depends on.
// Whoever keeps something has a row in CACHE_KINDS (io/cache/cache_folder), and lists what it
// consists of in one function, by which it is written and read (base/archive). The store does the
// rest: whole files only, a checksum over all of it, room. An entry that fails a check counts as
// missing. Called by io/mesh/mesh_cache, model/basis_cache and model/obtain.
//
//     CACHE/<key>.<ending>     head, blocks of bytes, checksum
//     CACHE/<key>.lock         there while a process makes what has this key (cache_lock)
//
// Keys hold for one build (base/computation), so formats may change; numbers are in the machine's
// own byte order.
#ifndef AMONTONS_IO_CACHE_STORE_H
#define AMONTONS_IO_CACHE_STORE_H

#include "base/archive.h"
#include "io/cache/cache_folder.h"
#include "io/files/file_lock.h"

enum { CACHE_NOTE_SIZE = 256 };   // of a note: why something was not used, or not kept

typedef struct CacheItem {
    CacheKind kind;
    const char *key;   // empty: it is not kept
    // Goes through all that there is to `self`, which is only read where the archive does not read.
    // Bytes may be anything that somebody has put a right checksum on: it checks what it counts on.
    void (*list)(void *self, Archive *archive);
    void *self;   // zeroed where it is to be read
} CacheItem;

// *found: it is there, whole, and all was as `list` wants it; else the caller destroys what was
// made of it, and `note` (NULL: nobody asks) says what is wrong with a file that is there.
bool cache_load(const CacheItem *item, bool *found, char *note, Error *err);

// Written beside and renamed. Where another process is writing the same nothing is done. Where the
// cache is then above its limit, files unused for the longest time go. false: it is not kept, and
// `note` says why; never an error.
bool cache_store(const CacheItem *item, char *note);
void cache_remove(CacheKind kind, const char *key);

// Waits while another process makes what has this key, some minutes at the most. true: no other
// will until file_lock_release; look once more whether it is there now. false: no lock is to be
// had, go on without.
bool cache_lock(const char *key, FileLock *lock);

#endif
