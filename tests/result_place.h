// SPDX-License-Identifier: GPL-2.0-or-later
// A folder of a test's own, made empty and removed with all that is in it. It lies in memory where
// there is room, since what is tested calls fsync for each file, which a disk takes its time for.
#ifndef AMONTONS_TESTS_RESULT_PLACE_H
#define AMONTONS_TESTS_RESULT_PLACE_H

#include "near.h"

#include <ftw.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>

enum { PLACE_SIZE = 256 };

static inline const char *place_root(void)
{
    static const uint64_t ROOM = 1 << 30;   // bytes that must be free in memory
    struct statvfs found;
    if (getenv("TMPDIR")) return getenv("TMPDIR");
    bool in_memory = access("/dev/shm", W_OK) == 0 && statvfs("/dev/shm", &found) == 0 &&
                     (uint64_t)found.f_bavail * found.f_frsize > ROOM;
    return in_memory ? "/dev/shm" : "/tmp";
}

static inline void place_make(char place[PLACE_SIZE])
{
    snprintf(place, PLACE_SIZE, "%s/amontons-XXXXXX", place_root());
    assert_non_null(mkdtemp(place));
}

static inline int place_remove_entry(const char *path, const struct stat *status, int type,
                                     struct FTW *walk)
{
    (void)status;
    (void)type;
    (void)walk;
    return remove(path);
}

static inline void place_remove(const char *place)
{
    nftw(place, place_remove_entry, 16, FTW_DEPTH | FTW_PHYS);
}

static inline const char *place_path(const char *place, const char *name)
{
    static char path[2 * PLACE_SIZE];
    snprintf(path, sizeof path, "%s/%s", place, name);
    return path;
}

static inline bool place_has(const char *place, const char *name)
{
    return access(place_path(place, name), F_OK) == 0;
}

static inline void place_write(const char *place, const char *name, const char *text)
{
    FILE *file = fopen(place_path(place, name), "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

// The whole of a text file, at most `size` - 1 bytes.
static inline void place_read(const char *place, const char *name, char *text, size_t size)
{
    FILE *file = fopen(place_path(place, name), "r");
    assert_non_null(file);
    text[fread(text, 1, size - 1, file)] = 0;
    fclose(file);
}

#endif
