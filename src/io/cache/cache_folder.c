// SPDX-License-Identifier: GPL-2.0-or-later
// The time of use is the file's access time, which io/cache/store sets itself when it reads: file
// systems mostly do not keep it.
#include "io/cache/cache_folder.h"

#include "base/memory.h"
#include "base/text.h"
#include "io/files/file_lock.h"
#include "io/files/part_file.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define PART ".part"   // io/files/part_file

static const int64_t LIMIT_DEFAULT = 2000000000;
static const double LIMIT_MOST = 1e18;   // bytes: an integer holds them

// Returns false also where the path would be too long: such a cache is as good as none.
bool cache_folder_path(char path[PATH_MAX])
{
    const char *given = getenv("AMONTONS_CACHE"), *base = getenv("XDG_CACHE_HOME");
    const char *home = getenv("HOME");
    int length = -1;
    if (given)
        length = snprintf(path, PATH_MAX, "%s", given);
    else if (base && base[0])
        length = snprintf(path, PATH_MAX, "%s/amontons", base);
    else if (home && home[0])
        length = snprintf(path, PATH_MAX, "%s/.cache/amontons", home);
    bool fits = length > 0 && length < PATH_MAX;
    if (!fits) path[0] = 0;
    return fits;
}

bool cache_folder_limit(int64_t *bytes, Error *err)
{
    static const struct {
        const char *ending;
        double factor;
    } units[] = {{"", 1}, {"K", 1e3}, {"M", 1e6}, {"G", 1e9}, {"T", 1e12}};
    const char *given = getenv("AMONTONS_CACHE_LIMIT");
    double number = 0;
    *bytes = LIMIT_DEFAULT;
    if (!given || !*given) return true;
    int32_t length = text_number(given, &number);
    for (size_t k = 0; length > 0 && k < sizeof units / sizeof *units; k++) {
        double size = number * units[k].factor;
        if (strcmp(given + length, units[k].ending) != 0 || !(size >= 0 && size < LIMIT_MOST))
            continue;
        *bytes = (int64_t)size;
        return true;
    }
    return REFUSE(err,
                  "AMONTONS_CACHE_LIMIT: found `%.40s`; allowed: a number of bytes, as in "
                  "500000000, 500M or 10G",
                  given);
}

static int by_use(const void *left, const void *right)
{
    const CacheFolderEntry *a = left, *b = right;
    if (a->used != b->used) return a->used < b->used ? -1 : 1;
    return strcmp(a->name, b->name);
}

bool cache_folder_read(CacheFolder *folder, Error *err)
{
    // A file of ours has a name of 32 digits and letters, and an ending that only we use (.lock is
    // that of a process, also of one that was killed); or it is a part of such a file.
#define ENDING(kind, ending, name) "." ending, "." ending PART,
    static const char *const endings[] = {CACHE_KINDS(ENDING) ".shape", ".lock"};
#undef ENDING
    DIR *listing = NULL;
    *folder = (CacheFolder){0};
    if (!cache_folder_path(folder->path)) return true;
    listing = opendir(folder->path);
    if (!listing && errno != ENOENT)
        FAIL(err, ERROR_FILE, "cannot read the folder %s: %s", folder->path, strerror(errno));
    for (struct dirent *file; listing && (file = readdir(listing));) {
        const char *name = file->d_name;
        size_t key = strspn(name, "0123456789abcdef");
        bool ours = false;
        struct stat about;
        for (size_t k = 0; key == 32 && k < sizeof endings / sizeof *endings; k++)
            ours = ours || strcmp(name + key, endings[k]) == 0;
        if (!ours || fstatat(dirfd(listing), name, &about, AT_SYMLINK_NOFOLLOW) != 0 ||
            !S_ISREG(about.st_mode))
            continue;
        TRY(memory_grow(&folder->entries, folder->count, &folder->room, sizeof *folder->entries,
                        err));
        CacheFolderEntry *entry = &folder->entries[folder->count++];
        double read = (double)about.st_atim.tv_sec + 1e-9 * (double)about.st_atim.tv_nsec;
        double written = (double)about.st_mtim.tv_sec + 1e-9 * (double)about.st_mtim.tv_nsec;
        *entry =
            (CacheFolderEntry){.bytes = about.st_size, .used = read > written ? read : written};
        memcpy(entry->name, name, strlen(name));   // 43 characters at most
        folder->bytes += entry->bytes;
    }
    if (folder->count > 0)
        qsort(folder->entries, (size_t)folder->count, sizeof *folder->entries, by_use);
cleanup:
    if (listing) closedir(listing);
    return error_is_clean(err);
}

void cache_folder_destroy(CacheFolder *folder)
{
    memory_free(folder->entries);
    *folder = (CacheFolder){0};
}

int32_t cache_folder_trim(const CacheFolder *folder, int64_t limit, const char *keep,
                          int64_t *bytes)
{
    int32_t removed = 0;
    *bytes = 0;
    for (int32_t k = 0; k < folder->count && folder->bytes - *bytes > limit; k++) {
        char path[PATH_MAX + CACHE_ENTRY_SIZE + 1];
        CacheFolderEntry *entry = &folder->entries[k];
        snprintf(path, sizeof path, "%s/%s", folder->path, entry->name);
        if (keep && strcmp(path, keep) == 0) continue;
        char *part = path + strlen(path) - strlen(PART);
        bool gone = false, held = false;
        if (strcmp(part, PART) == 0) {
            // A part is what a killed process left; or somebody writes it, and it stays.
            PartFile file = {0};
            Error unseen = {0};
            *part = 0;
            gone = part_file_try(&file, path, &unseen);
            held = file.taken;
            part_file_discard(&file);
        } else if (strcmp(part, ".lock") == 0) {
            FileLock lock;   // a lock that somebody holds stays
            gone = file_lock_take(&lock, path, 0);
            held = lock.busy;
            file_lock_release(&lock);
        } else {
            gone = unlink(path) == 0;
            held = errno == ENOENT;
        }
        entry->failed = !gone && !held;
        if (!gone) continue;
        removed++;
        *bytes += entry->bytes;
    }
    return removed;
}
