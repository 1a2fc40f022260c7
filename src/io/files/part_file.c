// SPDX-License-Identifier: GPL-2.0-or-later
// The lock is flock's: it ends when the file is closed or the process dies, and leaves nothing to
// clean up. rename(2) is atomic within a file system, which a file and its .part share.
#include "io/files/part_file.h"

#include "base/clock.h"
#include "base/transfer.h"
#include "io/files/file_lock.h"
#include "io/files/open_file.h"
#include "io/files/own_list.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

// A process that drew for one that was killed takes a moment to end, and its lock with it.
static const double LOCK_WAIT = 1;   // s
static const struct timespec PAUSE = {.tv_nsec = 10000000};   // between two tries: 10 ms

bool part_file_name(const char *path, char *part)
{
    size_t length = strlen(path);
    if (length == 0 || length >= PATH_MAX - 8) return false;
    snprintf(part, PATH_MAX + 8, "%s.part", path);
    return true;
}

// Opens the part and locks it, and checks that the name is still that of what was locked (another
// writer may have renamed it meanwhile); else again. Not emptied when opened: only the holder of
// the lock may do that.
static bool open_part(PartFile *file, const char *path, OpenAs as, double wait, Error *err)
{
    char why[OPEN_WHY_SIZE];
    double until = clock_seconds() + wait;
    while (!file->open) {
        file->descriptor = open_to_write(file->part, as, why);
        if (file->descriptor < 0) return FAULT(err, ERROR_FILE, "cannot write %s: %s", path, why);
        file->open = true;
        if (file_lock_try(file->descriptor) == LOCK_BUSY) {
            part_file_leave(file);
            if (clock_seconds() < until && nanosleep(&PAUSE, NULL) == 0) continue;
            file->taken = true;
            return FAULT(err, ERROR_FILE, "cannot write %s: another process is writing %s", path,
                         file->part);
        }
        if (!file_is_named(file->part, file->descriptor)) part_file_leave(file);
    }
    return true;
}

static bool name_part(PartFile *file, const char *path, Error *err)
{
    *file = (PartFile){0};
    if (!part_file_name(path, file->part))
        return FAULT(err, ERROR_FILE, "the name of the file to write is empty or too long: \"%s\"",
                     path);
    snprintf(file->path, sizeof file->path, "%s", path);
    return true;
}

static bool refuse_taken(const char *path, Error *err)
{
    return REFUSE(err,
                  "%s is there already: name another file or folder, say --overwrite, or move it "
                  "away",
                  path);
}

// Where `may_go` is false, a part with something in it stays as it is.
static bool create_part(PartFile *file, const char *path, bool may_go, double wait, Error *err)
{
    struct stat status = {0};
    TRY(open_part(file, path, OPEN_KEPT, wait, err));
    if (!may_go && fstat(file->descriptor, &status) == 0 && status.st_size > 0)
        TRY(refuse_taken(file->part, err));
    if (ftruncate(file->descriptor, 0) != 0)
        FAIL(err, ERROR_FILE, "cannot write %s: %s", path, strerror(errno));
cleanup:
    if (!error_is_clean(err)) part_file_leave(file);
    return error_is_clean(err);
}

bool part_file_create(PartFile *file, const char *path, Error *err)
{
    return part_file_replace(file, path, false, err);
}

// Listed as soon as the part is known to be ours: before anything is written into it. A kill
// between the two leaves an empty part, which is nobody's.
bool part_file_replace(PartFile *file, const char *path, bool overwrite, Error *err)
{
    TRY(name_part(file, path, err));
    bool there = open_holds_something(path), listed = false;
    if (there || open_is_there(file->part)) TRY(own_list_has(path, &listed, err));
    if (there && !listed && !overwrite) TRY(refuse_taken(path, err));
    TRY(create_part(file, path, listed || overwrite, LOCK_WAIT, err));
    if (!listed && !own_list_add(path, err)) {
        error_context(err, "cannot write %s", path);
        part_file_discard(file);
    }
cleanup:
    return error_is_clean(err);
}

bool part_file_try(PartFile *file, const char *path, Error *err)
{
    return name_part(file, path, err) && create_part(file, path, true, 0, err);
}

bool part_file_reopen(PartFile *file, const char *path, Error *err)
{
    if (!name_part(file, path, err)) return false;
    if (rename(path, file->part) != 0 && errno != ENOENT)
        return FAULT(err, ERROR_FILE, "cannot go on with %s: %s", path, strerror(errno));
    return open_part(file, path, OPEN_THERE, LOCK_WAIT, err);
}

bool part_file_begin_next(const PartFile *file, PartFile *next, Error *err)
{
    return part_file_replace(next, file->part, true, err);
}

// The lock of the new one is held before the other's is given up.
bool part_file_take_next(PartFile *file, PartFile *next, Error *err)
{
    int cause = transfer_sync(next->descriptor);
    if (cause)
        return FAULT(err, ERROR_FILE, "cannot write %s to disk: %s", file->part, strerror(cause));
    if (rename(next->part, file->part) != 0)
        return FAULT(err, ERROR_FILE, "cannot rename %s to %s: %s", next->part, file->part,
                     strerror(errno));
    close(file->descriptor);
    file->descriptor = next->descriptor;
    next->open = false;
    return true;
}

bool part_file_write(PartFile *file, const void *bytes, int64_t size, Error *err)
{
    int cause = transfer_write(file->descriptor, bytes, size, -1);
    if (cause) return FAULT(err, ERROR_FILE, "cannot write %s: %s", file->path, strerror(cause));
    return true;
}

// Synced before it is renamed: a power cut could otherwise leave the name without its bytes.
bool part_file_commit(PartFile *file, Error *err)
{
    int cause = transfer_sync(file->descriptor);
    if (cause)
        return FAULT(err, ERROR_FILE, "cannot write %s to disk: %s", file->path, strerror(cause));
    if (rename(file->part, file->path) != 0)
        return FAULT(err, ERROR_FILE, "cannot rename %s to %s: %s", file->part, file->path,
                     strerror(errno));
    part_file_leave(file);   // there is no part any more: this only closes
    return true;
}

bool part_file_put(const char *path, bool overwrite, const void *bytes, int64_t size, Error *err)
{
    PartFile file = {0};
    TRY(part_file_replace(&file, path, overwrite, err));
    TRY(part_file_write(&file, bytes, size, err));
    TRY(part_file_commit(&file, err));
cleanup:
    part_file_discard(&file);
    return error_is_clean(err);
}

void part_file_discard(PartFile *file)
{
    if (file->open) unlink(file->part);
    part_file_leave(file);
}

void part_file_leave(PartFile *file)
{
    if (file->open) close(file->descriptor);
    file->open = false;
}
