// SPDX-License-Identifier: GPL-2.0-or-later
// The folder of the cache: where it is, what is in it, and how it stays below its limit: what was
// not used for the longest time goes first, also what killed processes left half written. Nothing
// but our own files is looked at. Called by io/cache/store and run/info/cache.
#ifndef AMONTONS_IO_CACHE_CACHE_FOLDER_H
#define AMONTONS_IO_CACHE_CACHE_FOLDER_H

#include "base/error.h"

#include <limits.h>

// X(kind, ending of its files, what notes call it)
#define CACHE_KINDS(X)                                                                             \
    X(CACHE_MESH, "mesh", "mesh")                                                                  \
    X(CACHE_BASIS, "basis", "basis")                                                               \
    X(CACHE_MODES, "modes", "basis")

#define CACHE_KIND(kind, ending, name) kind,
typedef enum CacheKind { CACHE_KINDS(CACHE_KIND) CACHE_KIND_COUNT } CacheKind;
#undef CACHE_KIND

enum { CACHE_ENTRY_SIZE = 48 };

typedef struct CacheFolderEntry {
    char name[CACHE_ENTRY_SIZE];   // of the file
    int64_t bytes;
    double used;   // when it was last written or read, s since 1970
    bool failed;   // cache_folder_trim could not remove it, though no process holds it
} CacheFolderEntry;

typedef struct CacheFolder {
    char path[PATH_MAX];
    int32_t count, room;
    CacheFolderEntry *entries;   // [count] the longest unused first; owned
    int64_t bytes;   // of all of them
} CacheFolder;

// $AMONTONS_CACHE, else $XDG_CACHE_HOME/amontons, else ~/.cache/amontons. false: there is no cache
// ($AMONTONS_CACHE is empty, or none of the three is set).
bool cache_folder_path(char path[PATH_MAX]);

// $AMONTONS_CACHE_LIMIT ("500M", "10G"), else 2 GB. ERROR_INPUT: it is no number of bytes.
bool cache_folder_limit(int64_t *bytes, Error *err);

// A folder that is not there is empty.
bool cache_folder_read(CacheFolder *folder, Error *err);
void cache_folder_destroy(CacheFolder *folder);

// Removes the longest unused files until all together are at most `limit` bytes; not `keep` (a
// path; NULL: none); limit -1: all of them, also empty ones. What another process holds or has
// removed meanwhile is passed over, and so is what may not be removed, which is marked `failed`.
// removed: how many, and their bytes in *bytes.
int32_t cache_folder_trim(const CacheFolder *folder, int64_t limit, const char *keep,
                          int64_t *bytes);

#endif
