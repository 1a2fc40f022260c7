// SPDX-License-Identifier: GPL-2.0-or-later
// Bytes go into the file, and into its checksum, by blocks.
#include "io/cache/store.h"

#include "base/hash.h"
#include "base/memory.h"
#include "base/transfer.h"
#include "io/cache/cache_folder.h"
#include "io/files/folder.h"
#include "io/files/open_file.h"
#include "io/files/part_file.h"

#include <stdatomic.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { BLOCK_SIZE = 1 << 16, KEY_SIZE = HASH_TEXT_SIZE - 1, PATH_SIZE = PATH_MAX + 64 };

// s: the largest basis that model/obtain asks for takes a minute of a core to itself; twice the
// work, done by both, is better than waiting for a process that was stopped.
static const double WAIT_MAX = 300;

#define ENDING(kind, ending, name) [kind] = ending,
static const char *const endings[] = {CACHE_KINDS(ENDING)};
#define NAME(kind, ending, name) [kind] = name,
static const char *const names[] = {CACHE_KINDS(NAME)};

typedef struct Head {
    char magic[16], key[KEY_SIZE], ending[8];
    int64_t size;   // bytes between head and checksum
} Head;

static Head make_head(const CacheItem *item, int64_t size)
{
    Head head = {.size = size};
    memcpy(head.magic, "amontons-cache 6", sizeof head.magic);   // without its NUL
    memcpy(head.key, item->key, strnlen(item->key, KEY_SIZE));
    memcpy(head.ending, endings[item->kind], strlen(endings[item->kind]));
    return head;
}

// Finds a path in the cache's folder, which is made. false: there is no cache, or nothing to look
// for.
static bool find_path(const char *key, const char *ending, char path[PATH_SIZE])
{
    char folder[PATH_MAX];
    Error unseen = {0};   // a failure shows when the file is opened
    if (!key[0] || !cache_folder_path(folder)) return false;
    folder_make(folder, &unseen);
    snprintf(path, PATH_SIZE, "%s/%s.%s", folder, key, ending);
    return true;
}

// --- reading ------------------------------------------------------------------------------------

// Returns what is wrong with the bytes of a file, or NULL. *length: bytes between head and
// checksum.
static const char *find_fault(const CacheItem *item, const char *bytes, int64_t size,
                              int64_t *length)
{
    Head head, wanted = make_head(item, 0);
    Hash hash = hash_start();
    char digest[HASH_TEXT_SIZE];
    if (size < (int64_t)sizeof head || memcmp(bytes, wanted.magic, sizeof wanted.magic) != 0)
        return "it is not a cache file of this version";
    memcpy(&head, bytes, sizeof head);
    *length = wanted.size = head.size;
    if (memcmp(&head, &wanted, sizeof head) != 0) return "it belongs to another shape";
    int64_t left = size - (int64_t)sizeof head - KEY_SIZE;
    if (left < *length) return "it is cut off";
    for (int64_t at = 0, end = size - KEY_SIZE; at < end; at += BLOCK_SIZE)
        hash_bytes(&hash, bytes + at, (size_t)(end - at < BLOCK_SIZE ? end - at : BLOCK_SIZE));
    hash_write(&hash, digest);
    if (left > *length || memcmp(bytes + size - KEY_SIZE, digest, KEY_SIZE) != 0)
        return "its checksum does not hold";
    return NULL;
}

bool cache_load(const CacheItem *item, bool *found, char *note, Error *err)
{
    char path[PATH_SIZE];
    void *bytes = NULL;
    int64_t size = 0, length = 0;
    struct stat what;
    Error unseen = {0};
    *found = false;
    if (!find_path(item->key, endings[item->kind], path)) return true;

    // All of the file, as it may be replaced meanwhile.
    int descriptor = open_to_read(path, &unseen);
    if (descriptor >= 0 && fstat(descriptor, &what) == 0 && S_ISREG(what.st_mode)) {
        // Read now: io/cache/cache_folder removes what was not for the longest time.
        const struct timespec times[2] = {{.tv_nsec = UTIME_NOW}, {.tv_nsec = UTIME_OMIT}};
        futimens(descriptor, times);
        bytes = memory_bytes(what.st_size, err);
        if (bytes) size = transfer_read(descriptor, bytes, what.st_size, -1);
    }
    if (descriptor >= 0) close(descriptor);
    if (!bytes) goto cleanup;

    // Its head and checksum, then its contents, as `list` wants them.
    const char *fault = find_fault(item, bytes, size, &length);
    if (!fault) {
        Archive archive = archive_read((char *)bytes + sizeof(Head), length);
        archive.err = err;
        item->list(item->self, &archive);
        if (archive.failed || archive.at != length) fault = "an array is missing or wrong";
    }
    *found = !fault;
    if (fault && note)
        snprintf(note, CACHE_NOTE_SIZE, "a cached %s is not used: %s", names[item->kind], fault);
cleanup:
    memory_free(bytes);
    return error_is_clean(err);
}

// --- writing ------------------------------------------------------------------------------------

typedef struct Writing {
    PartFile part;
    Hash hash;   // of the blocks so far
    char *block;   // [BLOCK_SIZE] what is to be written next; owned
    int64_t filled;   // bytes of it
    Error *err;
} Writing;

static bool flush(Writing *file)
{
    hash_bytes(&file->hash, file->block, (size_t)file->filled);
    bool written = part_file_write(&file->part, file->block, file->filled, file->err);
    file->filled = 0;
    return written;
}

static bool append(void *self, const void *bytes, int64_t size)
{
    Writing *file = self;
    for (const char *from = bytes; size > 0;) {
        int64_t room = BLOCK_SIZE - file->filled, count = size < room ? size : room;
        memcpy(file->block + file->filled, from, (size_t)count);
        file->filled += count;
        from += count;
        size -= count;
        if (file->filled == BLOCK_SIZE && !flush(file)) return false;
    }
    return true;
}

static _Atomic int64_t unlooked;   // bytes that this process may write before it looks

// Looking through a folder of thousands of files takes longer than most writing, so that a process
// looks again when it has written an eighth of what was free, and then makes some room.
static void stay_below_limit(const char *path, int64_t written)
{
    enum { LOOK_AT = 8, MADE_FREE = 16 };   // of what was free; of the limit
    Error unseen = {0};
    CacheFolder folder = {0};
    int64_t bytes = 0, limit = 0;
    if (atomic_fetch_sub(&unlooked, written) > written) return;
    // One that cannot be looked through stays as it is: what was written is there.
    if (cache_folder_limit(&limit, &unseen) && cache_folder_read(&folder, &unseen) &&
        folder.bytes > limit)
        cache_folder_trim(&folder, limit - limit / MADE_FREE, path, &bytes);
    atomic_store(&unlooked, (limit - folder.bytes + bytes) / LOOK_AT);
    cache_folder_destroy(&folder);
}

bool cache_store(const CacheItem *item, char *note)
{
    char path[PATH_SIZE], digest[HASH_TEXT_SIZE];
    Error failure = {0}, *err = &failure;
    if (!find_path(item->key, endings[item->kind], path)) return true;
    Writing file = {.hash = hash_start(), .err = err};
    Archive measured = archive_measure(), archive = archive_send(append, &file);
    item->list(item->self, &measured);
    Head head = make_head(item, measured.at);
    TRY(file.block = memory_bytes(BLOCK_SIZE, err));
    if (!part_file_try(&file.part, path, err)) {
        if (file.part.taken) error_clear(err);   // it writes the same: the key says so
        goto cleanup;
    }
    TRY(append(&file, &head, sizeof head));
    item->list(item->self, &archive);
    TRY(!archive.failed && (file.filled == 0 || flush(&file)));
    hash_write(&file.hash, digest);
    TRY(part_file_write(&file.part, digest, KEY_SIZE, err));
    TRY(part_file_commit(&file.part, err));
    stay_below_limit(path, head.size);
cleanup:
    part_file_discard(&file.part);
    memory_free(file.block);
    if (!error_is_clean(err) && note)
        snprintf(note, CACHE_NOTE_SIZE, "the %s is not kept for the next run: %.180s",
                 names[item->kind], err->message);
    return error_is_clean(err);
}

void cache_remove(CacheKind kind, const char *key)
{
    char path[PATH_SIZE];
    if (find_path(key, endings[kind], path)) unlink(path);
}

bool cache_lock(const char *key, FileLock *lock)
{
    char path[PATH_SIZE];
    *lock = (FileLock){0};
    return find_path(key, "lock", path) && file_lock_take(lock, path, WAIT_MAX);
}
