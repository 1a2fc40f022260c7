// SPDX-License-Identifier: GPL-2.0-or-later
// The files of an earlier result that its list names (io/files/own_list) are removed in two steps.
// clear moves them, and the list last, into a folder of their own; settle removes that once the new
// result has begun; without it, release puts them back. At whatever moment a run is killed, the
// name of that folder says what the next process that claims the place has to do:
//   amontons.aside     files were on their way, there or back: back
//   amontons.earlier   all were there: what the new run left goes, then back
//   amontons.gone      the new run had begun: they go
#include "run/result/result_folder.h"

#include "io/files/folder.h"
#include "io/files/open_file.h"
#include "io/files/own_list.h"

#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { PATH_SIZE = PATH_MAX + 300 };

// A run that was killed while a child process read for it (base/child_process) leaves that for a
// moment, with its lock; s.
static const double LOCK_WAIT = 1;
static const char LOCK_NAME[] = "amontons.lock";
static const char ASIDE[] = "amontons.aside", EARLIER[] = "amontons.earlier",
                  GONE[] = "amontons.gone";
// Endings of a file: none when it is whole, .part while it is written, .part.part while it is
// written to replace a .part.
static const char *const ENDINGS[] = {"", ".part", ".part.part"};
enum { ENDING_COUNT = sizeof ENDINGS / sizeof *ENDINGS };

// Moves `name` of the folder `from` to `to_name` of `to` (AT_FDCWD: they are paths), or for good
// where that is empty. What is not there is no failure.
static bool move_entry(int from, const char *name, int to, const char *to_name, Error *err)
{
    int failed = *to_name ? renameat(from, name, to, to_name) : unlinkat(from, name, 0);
    if (failed && errno != ENOENT)
        return FAULT(err, ERROR_FILE, "cannot remove the earlier result %s: %s", name,
                     strerror(errno));
    return true;
}

// All files that the list of the folder `list` names, from the folder `from` into `to`, or for good
// where that is empty; folders in `from` that are empty then go, too. A list may be a stranger's,
// and so may be what lies in either folder: no link is followed (io/files/folder).
static bool move_listed(const char *list, const char *from, const char *to, Error *err)
{
    char name[OWN_NAME_SIZE], inner[OWN_NAME_SIZE], file[OWN_NAME_SIZE + 16], path[PATH_SIZE];
    int source = -1, target = -1;
    FILE *names = own_list_open(list, err);
    while (names && own_list_next(names, name)) {
        // The folder of the file: `from` itself, or one in it.
        const char *slash = strchr(name, '/'), *last = slash ? slash + 1 : name;
        snprintf(inner, sizeof inner, "%.*s", slash ? (int)(slash - name) : 0, name);
        source = folder_open_inside(from, inner, false);
        if (source < 0) continue;
        if (*to && (target = folder_open_inside(to, inner, true)) < 0) {
            int cause = errno;
            TRY(folder_check_inside(to, inner, err));
            FAIL(err, ERROR_FILE, "cannot move %s/%s into %s: %s", from, name, to, strerror(cause));
        }

        for (int k = 0; k < ENDING_COUNT; k++) {
            snprintf(file, sizeof file, "%s%s", last, ENDINGS[k]);
            struct stat status;   // a folder is no file that a list could name
            bool is_folder = fstatat(source, file, &status, AT_SYMLINK_NOFOLLOW) == 0 &&
                             S_ISDIR(status.st_mode);
            if (is_folder || move_entry(source, file, target, *to ? file : "", err)) continue;
            error_context(err, "%s", from);
            goto cleanup;
        }
        close(source);
        if (target >= 0) close(target);
        source = target = -1;
        snprintf(path, sizeof path, "%s/%s", from, inner);
        if (slash) rmdir(path);
    }
cleanup:
    if (source >= 0) close(source);
    if (target >= 0) close(target);
    if (names) fclose(names);
    return error_is_clean(err);
}

static bool move_list(const char *from, const char *to, Error *err)
{
    char path[PATH_SIZE], target[PATH_SIZE] = "";
    snprintf(path, sizeof path, "%s/" OWN_LIST_NAME, from);
    if (*to) snprintf(target, sizeof target, "%s/" OWN_LIST_NAME, to);
    return move_entry(AT_FDCWD, path, AT_FDCWD, target, err);
}

static bool rename_aside(const char *folder, const char *from, const char *to, Error *err)
{
    char path[PATH_SIZE], target[PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s", folder, from);
    snprintf(target, sizeof target, "%s/%s", folder, to);
    return move_entry(AT_FDCWD, path, AT_FDCWD, target, err);
}

// Empties folder/name into `to`, or for good, and removes it. Its list is there, or still, or
// again, in `folder`.
static bool end_aside(const char *folder, const char *name, const char *to, Error *err)
{
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    bool has_list = own_list_is_in(path) || !*to;
    if (!move_listed(has_list ? path : folder, path, to, err)) return false;
    if (has_list && !move_list(path, to, err)) return false;
    rmdir(path);
    return true;
}

static bool is_folder(const char *folder, const char *name)
{
    char path[PATH_SIZE];
    struct stat what;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return lstat(path, &what) == 0 && S_ISDIR(what.st_mode);
}

// Puts back the files that a computation which failed, or was killed, has left aside: see above.
static bool put_back(const char *folder, Error *err)
{
    if (is_folder(folder, GONE) && !end_aside(folder, GONE, "", err)) return false;
    if (is_folder(folder, EARLIER)) {
        if (!move_listed(folder, folder, "", err) || !move_list(folder, "", err)) return false;
        if (!rename_aside(folder, EARLIER, ASIDE, err)) return false;
    }
    return !is_folder(folder, ASIDE) || end_aside(folder, ASIDE, folder, err);
}

// Takes the lock of a folder, and writes into its file who holds it. Where the folder takes no lock
// file at all the work goes on, and shows at its first file what is wrong. ERROR_INPUT: another
// process holds the lock, or the file is no lock of ours.
static bool take_lock(const char *folder, FileLock *lock, Error *err)
{
    char path[PATH_SIZE], host[65] = "", holder[128] = "";
    snprintf(path, sizeof path, "%s/%s", folder, LOCK_NAME);
    if (file_lock_take(lock, path, LOCK_WAIT)) {
        gethostname(host, sizeof host - 1);
        dprintf(lock->descriptor, "process %ld on %s\n", (long)getpid(), host);
    } else if (lock->busy) {
        Error ignored = {0};
        FILE *stream = open_stream(path, &ignored);
        if (stream) {
            if (!fgets(holder, sizeof holder, stream)) *holder = 0;
            fclose(stream);
        }
        holder[strcspn(holder, "\n")] = 0;
        return REFUSE(err,
                      "%s: another computation is writing its result there (%s): choose another "
                      "folder (-o), or wait until it has ended",
                      folder, *holder ? holder : "its process is not known");
    } else if (open_is_there(path)) {
        return REFUSE(err, "%s is there, and is no lock of ours: move it away", path);
    }
    return true;
}

// Returns true if the result that lies in a folder was cut off: there is a checkpoint, and no
// report of a run that came to its end.
static bool was_cut_off(const char *folder)
{
    char path[PATH_SIZE], start[128] = "";
    Error ignored = {0};
    snprintf(path, sizeof path, "%s/%s", folder, CHECKPOINT_FILE);
    if (access(path, F_OK) != 0) return false;
    snprintf(path, sizeof path, "%s/run.json", folder);
    FILE *report = open_stream(path, &ignored);
    if (!report) return true;
    start[fread(start, 1, sizeof start - 1, report)] = 0;
    fclose(report);
    return !strstr(start, "\"done\"");
}

bool result_folder_claim(const char *path, bool overwrite, ResultFolder *folder, Error *err)
{
    static const char stopped[] = "figures/accuracy.";
    static const char *const needed[] = {"run.json", "history.h5", "static.json", "stability.json",
                                         "model1d.json"};
    char found[PATH_SIZE], name[OWN_NAME_SIZE];
    *folder = (ResultFolder){0};
    if (!path) return true;
    TRY(folder_make(path, err));
    if (access(path, W_OK | X_OK) != 0)   // told at once
        FAIL(err, ERROR_FILE, "cannot write into %s: %s", path, strerror(errno));
    if (strlen(path) >= sizeof folder->path)
        FAIL(err, ERROR_INPUT, "the path of the result folder is too long");
    memcpy(folder->path, path, strlen(path) + 1);
    TRY(take_lock(path, &folder->lock, err));

    // Files that an earlier computation left aside are put back. A file of somebody's under one of
    // the names written last is refused now; all others are refused when they are written.
    TRY(put_back(path, err));
    TRY(own_list_check(path, err));
    for (size_t k = 0; k < sizeof needed / sizeof *needed; k++) {
        snprintf(found, PATH_SIZE, "%s/%s", path, needed[k]);
        TRY(own_list_refuse_taken(found, err));
    }

    // Find the first file of an earlier result that lies there: `found`. The search for an error
    // bar, stopped, leaves accuracy.json and .png alone, and begins anew.
    FILE *names = own_list_open(path, err);
    while (names && !folder->has_earlier && own_list_next(names, name)) {
        if (!overwrite && strncmp(name, stopped, sizeof stopped - 1) == 0) continue;
        for (int k = 0; k < ENDING_COUNT && !folder->has_earlier; k++) {
            snprintf(found, PATH_SIZE, "%s/%s%s", path, name, ENDINGS[k]);
            folder->has_earlier = open_is_there(found);
        }
    }
    if (names) fclose(names);
    if (!error_is_clean(err) || !folder->has_earlier || overwrite) goto cleanup;
    if (was_cut_off(path))
        FAIL(err, ERROR_INPUT,
             "%s holds a result that was cut off: go on with it (--resume), choose another folder "
             "(-o) or say --overwrite",
             path);
    FAIL(err, ERROR_INPUT,
         "%s holds an earlier result (%s): choose another folder (-o) or say --overwrite", path,
         strrchr(found, '/') + 1);
cleanup:
    if (!error_is_clean(err)) result_folder_release(folder);
    return error_is_clean(err);
}

bool result_folder_clear(ResultFolder *folder, Error *err)
{
    char path[PATH_SIZE];
    if (!folder->path[0]) return true;
    if (!folder->has_earlier) return own_list_make(folder->path, err);
    snprintf(path, sizeof path, "%s/%s", folder->path, ASIDE);
    if (mkdir(path, 0777) != 0)
        return FAULT(err, ERROR_FILE, "cannot make %s for the earlier result: %s", path,
                     strerror(errno));
    folder->aside = true;
    if (!move_listed(folder->path, folder->path, path, err)) return false;
    if (!move_list(folder->path, path, err)) return false;
    if (!rename_aside(folder->path, ASIDE, EARLIER, err)) return false;
    folder->has_earlier = false;
    return own_list_make(folder->path, err);
}

bool result_folder_settle(ResultFolder *folder, Error *err)
{
    if (!folder->aside) return true;
    if (!rename_aside(folder->path, EARLIER, GONE, err)) return false;
    folder->aside = false;
    return end_aside(folder->path, GONE, "", err);
}

bool result_folder_take_up(ResultFolder *folder, Error *err)
{
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/run.json", folder->path);
    if (unlink(path) != 0 && errno != ENOENT)
        return FAULT(err, ERROR_FILE, "cannot remove the earlier report %s: %s", path,
                     strerror(errno));
    folder->has_earlier = false;
    return true;
}

bool result_folder_is_ours(const ResultFolder *folder)
{
    return folder->path[0] && !folder->has_earlier;
}

bool result_folder_is_settled(const ResultFolder *folder)
{
    return result_folder_is_ours(folder) && !folder->aside;
}

void result_folder_release(ResultFolder *folder)
{
    Error unseen = {0};   // the next who claims the folder tries again
    if (folder->aside) put_back(folder->path, &unseen);
    file_lock_release(&folder->lock);
    *folder = (ResultFolder){0};
}
