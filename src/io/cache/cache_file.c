// SPDX-License-Identifier: GPL-2.0-or-later
// The checksum covers head, names and values. Each array begins at a multiple of LINE bytes, as
// those of base/memory do, and can be used in place: some kernels of OpenBLAS (Prescott's) round by
// where a vector lies in a line, and an answer must not depend on whether a basis was read or made.
#include "io/cache/cache_file.h"

#include "base/hash.h"
#include "base/memory.h"
#include "io/cache/cache_folder.h"
#include "io/files/folder.h"
#include "io/files/open_file.h"
#include "io/files/part_file.h"

#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const char MAGIC[] = "amontons-cache 2\n";
enum { MAGIC_SIZE = sizeof MAGIC - 1, KEY_SIZE = HASH_TEXT_SIZE - 1, LINE = 64, HEAD_SIZE = LINE };
_Static_assert(MAGIC_SIZE + KEY_SIZE < HEAD_SIZE, "the head is too short");

// What stands before each array's values; a count below 0 ends the file.
typedef struct ArrayHead {
    char name[CACHE_NAME_SIZE];
    int64_t count;
    char spare[LINE - CACHE_NAME_SIZE - sizeof(int64_t)];
} ArrayHead;
_Static_assert(sizeof(ArrayHead) == LINE, "arrays would not begin with a line");

// Bytes behind an array of `count` numbers, up to the next line.
static int64_t bytes_behind(int64_t count)
{
    return -(count * (int64_t)sizeof(double)) & (LINE - 1);
}

bool cache_file_path(const char *key, const char *ending, char path[CACHE_PATH_SIZE])
{
    char folder[PATH_MAX];
    if (!cache_folder_path(folder)) return false;
    Error unseen = {0};   // a failure shows when the file is opened
    folder_make(folder, &unseen);
    snprintf(path, CACHE_PATH_SIZE, "%s/%s.%s", folder, key, ending);
    return true;
}

// The first HEAD_SIZE bytes: what the file is, and its key.
static void fill_head(const char *key, char head[HEAD_SIZE])
{
    memset(head, 0, HEAD_SIZE);
    memcpy(head, MAGIC, MAGIC_SIZE);
    memcpy(head + MAGIC_SIZE, key, strnlen(key, KEY_SIZE));
}

// Writes and adds to the checksum.
static bool write_counted(PartFile *part, Hash *hash, const void *bytes, int64_t size, Error *err)
{
    hash_bytes(hash, bytes, (size_t)size);
    return part_file_write(part, bytes, size, err);
}

// A cache that cannot be looked through stays as it is: what was written is there.
static void stay_below_limit(const char *path)
{
    Error unseen = {0};
    CacheFolder folder = {0};
    int64_t bytes = 0, limit = 0;
    if (cache_folder_limit(&limit, &unseen) && cache_folder_read(&folder, &unseen))
        cache_folder_trim(&folder, limit, path, &bytes);
    cache_folder_destroy(&folder);
}

bool cache_file_write(const char *path, const char *key, const CacheArray *arrays, int32_t count,
                      Error *err)
{
    PartFile part = {0};
    Hash hash = hash_start();
    char head[HEAD_SIZE], digest[HASH_TEXT_SIZE];
    fill_head(key, head);
    if (!part_file_try(&part, path, err)) {
        if (part.taken) error_clear(err);   // it writes the same: the key says so
        goto cleanup;
    }
    TRY(write_counted(&part, &hash, head, HEAD_SIZE, err));
    for (int32_t k = 0; k < count; k++) {
        ArrayHead before = {.count = arrays[k].count};
        memcpy(before.name, arrays[k].name, CACHE_NAME_SIZE);
        TRY(write_counted(&part, &hash, &before, sizeof before, err));
        TRY(write_counted(&part, &hash, arrays[k].values, arrays[k].count * (int64_t)sizeof(double),
                          err));
        TRY(write_counted(&part, &hash, (char[LINE]){0}, bytes_behind(arrays[k].count), err));
    }
    ArrayHead end = {.name = "end", .count = -1};
    TRY(write_counted(&part, &hash, &end, sizeof end, err));
    hash_write(&hash, digest);
    TRY(part_file_write(&part, digest, KEY_SIZE, err));
    TRY(part_file_commit(&part, err));
    stay_below_limit(path);
cleanup:
    part_file_discard(&part);
    return error_is_clean(err);
}

// All of a file; *bytes NULL when it cannot be opened.
static bool read_bytes(const char *path, void **bytes, int64_t *size, Error *err)
{
    *bytes = NULL;
    *size = 0;
    struct stat what;
    Error unseen = {0};
    int descriptor = open_to_read(path, &unseen);
    if (descriptor < 0) return true;
    if (fstat(descriptor, &what) == 0 && S_ISREG(what.st_mode)) {
        // Read now: io/cache/cache_folder removes what was not for the longest time.
        const struct timespec times[2] = {{.tv_nsec = UTIME_NOW}, {.tv_nsec = UTIME_OMIT}};
        futimens(descriptor, times);
        *bytes = memory_bytes(what.st_size, err);
        while (*bytes && *size < what.st_size) {
            ssize_t got = read(descriptor, (char *)*bytes + *size, (size_t)(what.st_size - *size));
            if (got <= 0) break;
            *size += got;
        }
    }
    close(descriptor);
    return error_is_clean(err);
}

// Fills the table of arrays, which point into `bytes`, and checks the sum. Returns what is wrong,
// or NULL. Every length is checked against what is left before it is used: a damaged file may hold
// anything.
static const char *parse(const char *key, const char *bytes, int64_t size, CacheFile *file)
{
    char head[HEAD_SIZE], digest[HASH_TEXT_SIZE];
    Hash hash = hash_start();
    fill_head(key, head);
    int64_t at = HEAD_SIZE;
    if (size < at || memcmp(bytes, MAGIC, MAGIC_SIZE) != 0)
        return "it is not a cache file of this version";
    if (memcmp(bytes, head, HEAD_SIZE) != 0) return "it belongs to another shape";
    hash_bytes(&hash, bytes, HEAD_SIZE);
    for (;;) {
        ArrayHead before;
        if (size - at < (int64_t)sizeof before) return "it is cut off";
        memcpy(&before, bytes + at, sizeof before);
        hash_bytes(&hash, bytes + at, sizeof before);
        at += (int64_t)sizeof before;
        if (before.count < 0) break;
        if (file->array_count == CACHE_ARRAYS_MAX || before.count > (size - at) / 8)
            return "it is cut off";
        CacheArray *array = &file->arrays[file->array_count++];
        memcpy(array->name, before.name, CACHE_NAME_SIZE);
        array->name[CACHE_NAME_SIZE - 1] = 0;
        array->count = before.count;
        array->values = (const double *)(const void *)(bytes + at);
        int64_t length = before.count * (int64_t)sizeof(double), rest = bytes_behind(before.count);
        if (length + rest > size - at) return "it is cut off";
        hash_bytes(&hash, bytes + at, (size_t)length);
        hash_bytes(&hash, bytes + at + length, (size_t)rest);
        at += length + rest;
    }
    hash_write(&hash, digest);
    if (size - at != KEY_SIZE || memcmp(bytes + at, digest, KEY_SIZE) != 0)
        return "its checksum does not hold";
    return NULL;
}

// Reads it whole, as the file may be replaced meanwhile.
bool cache_file_read(const char *path, const char *key, CacheFile *file, bool *found, char *reason,
                     Error *err)
{
    *file = (CacheFile){0};
    *found = false;
    reason[0] = 0;
    int64_t size = 0;
    TRY(read_bytes(path, &file->bytes, &size, err));
    if (!file->bytes) goto cleanup;
    const char *fault = parse(key, file->bytes, size, file);
    if (!fault) {
        *found = true;
    } else {
        snprintf(reason, CACHE_REASON_SIZE, "%s", fault);
        cache_file_destroy(file);
    }
cleanup:
    return error_is_clean(err);
}

void cache_file_destroy(CacheFile *file)
{
    memory_free(file->bytes);
    *file = (CacheFile){0};
}

// Valid until the file is destroyed.
const double *cache_file_array(const CacheFile *file, const char *name, int64_t count)
{
    for (int32_t k = 0; k < file->array_count; k++) {
        const CacheArray *array = &file->arrays[k];
        if (strncmp(array->name, name, CACHE_NAME_SIZE) != 0) continue;
        return count < 0 || array->count == count ? array->values : NULL;
    }
    return NULL;
}

bool cache_file_whole(const CacheFile *file, const char *name, int32_t count, double limit,
                      int32_t *values)
{
    const double *stored = cache_file_array(file, name, count);
    for (int32_t k = 0; stored && k < count; k++) {
        if (!(stored[k] >= 0 && stored[k] < limit) || stored[k] != floor(stored[k])) return false;
        values[k] = (int32_t)stored[k];
    }
    return stored != NULL;
}
