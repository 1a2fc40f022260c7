// SPDX-License-Identifier: GPL-2.0-or-later
// Of an earlier result go the files that run/own_file knows to be ours: those that prove a result,
// the numbered ones in fields/, and the figures. Where a file of such a name is somebody's, a run,
// which would write over it, is refused. A link in the place of fields/ or figures/ is not followed
// when files are removed. run.json and the checkpoint go first, so that a run that is killed from
// here on leaves neither a report of the one before nor half of it to go on with; the history goes
// last, as the proof.
#include "run/result_folder.h"

#include "io/folder.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { PATH_SIZE = PATH_MAX + 300 };

// A run that was killed while a process of its own read for it (base/apart) leaves that for a
// moment, with its lock; s.
static const double LOCK_WAIT = 1;
static const char LOCK_NAME[] = "amontons.lock", PART[] = ".part";

// A file in its place or a folder that cannot be written to is told at once.
static bool make_folder(const char *folder, Error *err)
{
    struct stat what;
    TRY(folder_make(folder, err));
    if (stat(folder, &what) != 0 || !S_ISDIR(what.st_mode))
        FAIL(err, ERROR_INPUT, "%s is a file, not a folder: choose another result folder (-o)",
             folder);
    if (access(folder, W_OK | X_OK) != 0)
        FAIL(err, ERROR_FILE, "cannot write into %s: %s", folder, strerror(errno));
cleanup:
    return error_is_clean(err);
}

// `name` without a PART at its end, in `bare` [NAME_MAX + 1].
static void strip_part(const char *name, char *bare)
{
    size_t length = strlen(name), end = sizeof PART - 1;
    if (length > end && strcmp(name + length - end, PART) == 0) length -= end;
    snprintf(bare, NAME_MAX + 1, "%.*s", (int)length, name);
}

// The own files of folder/name, told by `is_own`. A folder that is not there, or a link, is left.
static bool empty_folder(const char *folder, const char *name, bool (*is_own)(const char *),
                         Error *err)
{
    char path[PATH_SIZE], file[PATH_SIZE + NAME_MAX + 1], bare[NAME_MAX + 1];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    int opened = open(path, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    DIR *directory = opened < 0 ? NULL : fdopendir(opened);
    if (!directory) return true;
    for (struct dirent *entry = readdir(directory); entry; entry = readdir(directory)) {
        strip_part(entry->d_name, bare);
        snprintf(file, sizeof file, "%s/%s", path, entry->d_name);
        bool part = strcmp(bare, entry->d_name) != 0;
        if (is_own(bare) && (part || own_file_is_ours(file)) &&
            unlinkat(opened, entry->d_name, 0) != 0 && errno != ENOENT)
            FAIL(err, ERROR_FILE, "cannot remove the earlier result %s: %s", file, strerror(errno));
    }
cleanup:
    closedir(directory);
    return error_is_clean(err);
}

// Where a run would write over somebody's file. The search for an error bar, stopped, leaves
// accuracy.json and .png alone, and begins anew.
static bool refuse_taken(const char *folder, const char *name, bool (*is_own)(const char *),
                         bool ours_may_go, Error *err)
{
    char path[PATH_SIZE], file[PATH_SIZE + NAME_MAX + 1];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    DIR *directory = opendir(path);
    if (!directory) return true;
    for (struct dirent *entry = readdir(directory); entry; entry = readdir(directory)) {
        bool may_go = ours_may_go || strncmp(entry->d_name, "accuracy.", 9) == 0;
        snprintf(file, sizeof file, "%s/%s", path, entry->d_name);
        if (is_own(entry->d_name) && !(may_go && own_file_is_ours(file)))
            FAIL(err, ERROR_INPUT,
                 "%s is there, and nothing says that a run wrote it: choose another folder (-o), "
                 "or move it away",
                 file);
    }
cleanup:
    closedir(directory);
    return error_is_clean(err);
}

// The own file number k / 3, the unfinished one, and its journal; false: no more.
static bool own_path(const char *folder, int32_t k, char path[PATH_SIZE])
{
    static const char *const ends[] = {"", ".part", ".journal"};
    const char *name = own_file_name(k / 3);
    if (name) snprintf(path, PATH_SIZE, "%s/%s%s", folder, name, ends[k % 3]);
    return name;
}

// The first file of an earlier result, in `found`. One with such a name that is none is refused;
// unfinished ones are ours by their names.
static bool find_earlier(ResultFolder *folder, char found[PATH_SIZE], Error *err)
{
    char path[PATH_SIZE];
    for (int32_t k = 0; own_path(folder->path, k, path); k++) {
        if (access(path, F_OK) != 0) continue;
        if (k % 3 == 0 && !own_file_is_ours(path))
            FAIL(err, ERROR_INPUT,
                 "%s is there, and is none that a run wrote: choose another folder (-o), or move "
                 "it away",
                 path);
        if (!folder->has_earlier) memcpy(found, path, PATH_SIZE);
        folder->has_earlier = true;
    }
cleanup:
    return error_is_clean(err);
}

// Who holds the lock has written so into its file.
static bool take_lock(ResultFolder *folder, Error *err)
{
    char path[PATH_SIZE], host[65] = "", holder[128] = "";
    snprintf(path, sizeof path, "%s/%s", folder->path, LOCK_NAME);
    if (file_lock_take(&folder->lock, path, LOCK_WAIT)) {
        gethostname(host, sizeof host - 1);
        dprintf(folder->lock.descriptor, "process %ld on %s\n", (long)getpid(), host);
        return true;
    }
    if (!folder->lock.busy) return true;   // a file system without locks
    FILE *file = fopen(path, "r");
    if (file) {
        if (!fgets(holder, sizeof holder, file)) *holder = 0;
        fclose(file);
    }
    holder[strcspn(holder, "\n")] = 0;
    FAIL(err, ERROR_INPUT,
         "%s: another computation is writing its result there (%s): choose another folder (-o), or "
         "wait until it has ended",
         folder->path, *holder ? holder : "its process is not known");
cleanup:
    return false;
}

// There is a checkpoint, and no report of a run that came to its end.
static bool may_go_on(const char *folder)
{
    char path[PATH_SIZE], start[128] = "";
    snprintf(path, sizeof path, "%s/%s", folder, CHECKPOINT_FILE);
    if (access(path, F_OK) != 0) return false;
    snprintf(path, sizeof path, "%s/run.json", folder);
    FILE *report = fopen(path, "r");
    if (!report) return true;
    start[fread(start, 1, sizeof start - 1, report)] = 0;
    fclose(report);
    return !strstr(start, "\"done\"");
}

bool result_folder_claim(const char *path, bool overwrite, ResultFolder *folder, Error *err)
{
    char found[PATH_SIZE];
    *folder = (ResultFolder){0};
    if (!path) return true;
    TRY(make_folder(path, err));
    if (strlen(path) >= sizeof folder->path)
        FAIL(err, ERROR_INPUT, "the path of the result folder is too long");
    memcpy(folder->path, path, strlen(path) + 1);
    snprintf(found, sizeof found, "%s/%s", path, LOCK_NAME);
    folder->ours_may_go = overwrite || access(found, F_OK) == 0;
    TRY(take_lock(folder, err));
    TRY(find_earlier(folder, found, err));
    if (folder->has_earlier && !overwrite && may_go_on(path))
        FAIL(err, ERROR_INPUT,
             "%s holds a result that was cut off: go on with it (--resume), choose another folder "
             "(-o) or say --overwrite",
             path);
    if (folder->has_earlier && !overwrite)
        FAIL(err, ERROR_INPUT,
             "%s holds an earlier result (%s): choose another folder (-o) or say --overwrite", path,
             strrchr(found, '/') + 1);
    TRY(refuse_taken(path, "fields", own_file_is_field, folder->ours_may_go, err));
    TRY(refuse_taken(path, "figures", own_file_is_figure, folder->ours_may_go, err));
cleanup:
    if (!error_is_clean(err)) result_folder_release(folder);
    return error_is_clean(err);
}

// The own files from number `from` up to number `end`.
static bool remove_files(const char *folder, int32_t from, int32_t end, Error *err)
{
    char path[PATH_SIZE];
    for (int32_t k = 3 * from; k < 3 * end && own_path(folder, k, path); k++)
        if (unlink(path) != 0 && errno != ENOENT)
            FAIL(err, ERROR_FILE, "cannot remove the earlier result %s: %s", path, strerror(errno));
cleanup:
    return error_is_clean(err);
}

// Also without an earlier result: figures and fields of ours may lie there alone.
bool result_folder_clear(ResultFolder *folder, Error *err)
{
    enum { STATUS_FILES = 2, FILES_MAX = 1000 };   // report and checkpoint
    if (!folder->ours_may_go) return true;
    TRY(remove_files(folder->path, 0, STATUS_FILES, err));
    TRY(empty_folder(folder->path, "fields", own_file_is_field, err));
    TRY(empty_folder(folder->path, "figures", own_file_is_figure, err));
    TRY(remove_files(folder->path, STATUS_FILES, FILES_MAX, err));
    folder->has_earlier = false;
cleanup:
    return error_is_clean(err);
}

bool result_folder_take_up(ResultFolder *folder, Error *err)
{
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/run.json", folder->path);
    if (unlink(path) != 0 && errno != ENOENT)
        FAIL(err, ERROR_FILE, "cannot remove the earlier report %s: %s", path, strerror(errno));
    folder->has_earlier = false;
cleanup:
    return error_is_clean(err);
}

bool result_folder_is_ours(const ResultFolder *folder)
{
    return folder->path[0] && !folder->has_earlier;
}

void amontons_let_go(void)
{
    file_locks_let_go();
}

void result_folder_release(ResultFolder *folder)
{
    file_lock_release(&folder->lock);
    *folder = (ResultFolder){0};
}
