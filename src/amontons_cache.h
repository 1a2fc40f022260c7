// SPDX-License-Identifier: GPL-2.0-or-later
// The cache of reductions on disk. Public, as amontons.h.
#ifndef AMONTONS_CACHE_H
#define AMONTONS_CACHE_H

#include "amontons.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct CacheEntry {
    const char *name;   // of the file
    int64_t bytes;
    double used;   // when it was last written or read, s since 1970
} CacheEntry;
typedef void (*CacheCallback)(const CacheEntry *entry, void *context);

typedef struct CacheSummary {
    char folder[AMONTONS_PATH_SIZE];   // empty: there is no cache
    int64_t files, bytes;
    int64_t limit;   // bytes; what was not used for the longest time goes when it is passed
} CacheSummary;

// Lists the files in the cache, the longest unused first (on_entry may be NULL), and adds them up.
bool amontons_cache_list(CacheCallback on_entry, void *context, CacheSummary *summary, Error *err);
// Removes all of it but what a running process holds; removed: what that was. ERROR_FILE: a file
// could not be removed.
bool amontons_cache_clean(CacheSummary *removed, Error *err);

#ifdef __cplusplus
}
#endif

#endif
