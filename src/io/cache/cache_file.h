// SPDX-License-Identifier: GPL-2.0-or-later
// Named arrays of doubles in one flat file, quick to read (megabytes in a few milliseconds), with a
// header that says what it is and a checksum over all of it: what fails them is not used. Called by
// io/mesh/mesh_cache, model/shape_cache and model/basis_cache.
//
//     "amontons-cache 2\n" key 0...  { name count 0... values 0... }*  "end" -1 0...  checksum
//
// Head, names and values each begin at a multiple of 64 bytes.
//
// Numbers are in the machine's own byte order.
#ifndef AMONTONS_IO_CACHE_CACHE_FILE_H
#define AMONTONS_IO_CACHE_CACHE_FILE_H

#include "base/error.h"

#include <limits.h>

enum { CACHE_NAME_SIZE = 32, CACHE_ARRAYS_MAX = 32, CACHE_PATH_SIZE = PATH_MAX + 64 };
enum { CACHE_NOTE_SIZE = 256 };   // of a note: why something was not used, or not kept

// CACHE/<key>.<ending> in the folder of io/cache/cache_folder, which is made. false: there is no
// cache.
bool cache_file_path(const char *key, const char *ending, char path[CACHE_PATH_SIZE]);

typedef struct CacheArray {
    char name[CACHE_NAME_SIZE];
    int64_t count;
    const double *values;   // [count]; when read: inside CacheFile.bytes, 64-byte aligned
} CacheArray;

typedef struct CacheFile {
    int32_t array_count;
    CacheArray arrays[CACHE_ARRAYS_MAX];
    void *bytes;   // what was read; owned
} CacheFile;

// Writes beside `path` and renames. Where another process is writing the same file nothing is done,
// which is no error. Where the cache is then above its limit, files unused for the longest time go.
bool cache_file_write(const char *path, const char *key, const CacheArray *arrays, int32_t count,
                      Error *err);

// *found: it is there, has this key, and its checksum holds. Otherwise `reason` says what is wrong
// with it, empty where it is missing: no error.
bool cache_file_read(const char *path, const char *key, CacheFile *file, bool *found, char *reason,
                     Error *err);
enum { CACHE_REASON_SIZE = 160 };
void cache_file_destroy(CacheFile *file);

// The array called `name`, or NULL; `count` is checked when it is not negative.
const double *cache_file_array(const CacheFile *file, const char *name, int64_t count);

// The same as whole numbers into `values` [count]. false: it is missing, or one of them is not
// whole, below 0, or not below `limit` (a checksum says nothing about who wrote the file).
bool cache_file_whole(const CacheFile *file, const char *name, int32_t count, double limit,
                      int32_t *values);
enum { CACHE_COUNT_LIMIT = 1 << 28 };   // of what arrays are counted by

#endif
