// SPDX-License-Identifier: GPL-2.0-or-later
// Of an earlier result go the files that run/result/own_file names and io/files/own_mark knows to
// be ours: those that prove a result, the numbered ones in fields/, and the figures. Where a file
// of such a name is somebody's, a run, which would write over it, is refused. A link in the place
// of fields/ or figures/ is not followed.
//
// They go in two steps: clear moves them into a folder of their own, settle removes that once the
// new result has begun; without it, release puts them back. Whatever moment a kill meets, the name
// of that folder says what is to be done by the next who claims the place:
//   amontons.aside     files were on their way, there or back: back
//   amontons.earlier   all were there: what the new run left goes, then back
//   amontons.gone      the new run had begun: they go
#include "run/result/result_folder.h"

#include "io/files/folder.h"
#include "io/files/open_file.h"
#include "io/files/own_mark.h"

#include <dirent.h>
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
static const char LOCK_NAME[] = "amontons.lock", PART[] = ".part";
static const char ASIDE[] = "amontons.aside", EARLIER[] = "amontons.earlier",
                  GONE[] = "amontons.gone";

// A file in its place or a folder that cannot be written to is told at once.
static bool make_folder(const char *folder, Error *err)
{
    struct stat what;
    if (!folder_make(folder, err)) return false;
    if (stat(folder, &what) != 0 || !S_ISDIR(what.st_mode))
        return REFUSE(err, "%s is a file, not a folder: choose another result folder (-o)", folder);
    if (access(folder, W_OK | X_OK) != 0)
        return FAULT(err, ERROR_FILE, "cannot write into %s: %s", folder, strerror(errno));
    return true;
}

// `name` without a PART at its end, in `bare` [NAME_MAX + 1].
static void strip_part(const char *name, char *bare)
{
    size_t length = strlen(name), end = sizeof PART - 1;
    if (length > end && strcmp(name + length - end, PART) == 0) length -= end;
    snprintf(bare, NAME_MAX + 1, "%.*s", (int)length, name);
}

// Where the own files of a folder go: `to` is another, or empty: they are removed.
static bool move_file(const char *from, const char *to, Error *err)
{
    int failed = *to ? rename(from, to) : unlink(from);
    if (failed && errno != ENOENT)
        return FAULT(err, ERROR_FILE, "cannot remove the earlier result %s: %s", from,
                     strerror(errno));
    return true;
}

// Those of folder/name, told by `is_own`. A folder that is not there, or a link, is left.
static bool move_folder(const char *folder, const char *to, const char *name,
                        bool (*is_own)(const char *), Error *err)
{
    char path[PATH_SIZE], file[PATH_SIZE + NAME_MAX + 1], bare[NAME_MAX + 1];
    char target[PATH_SIZE + NAME_MAX + 1] = "";
    snprintf(path, sizeof path, "%s/%s", folder, name);
    int opened = open(path, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    DIR *directory = opened < 0 ? NULL : fdopendir(opened);
    if (!directory) return true;
    if (*to) {
        snprintf(target, sizeof target, "%s/%s", to, name);
        mkdir(target, 0777);   // a failure shows at the first file
    }
    for (struct dirent *entry = readdir(directory); entry; entry = readdir(directory)) {
        strip_part(entry->d_name, bare);
        snprintf(file, sizeof file, "%s/%s", path, entry->d_name);
        bool part = strcmp(bare, entry->d_name) != 0;
        if (!is_own(bare) || !(part || own_mark_is_in(file))) continue;
        if (*to) snprintf(target, sizeof target, "%s/%s/%s", to, name, entry->d_name);
        TRY(move_file(file, target, err));
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
        if (is_own(entry->d_name) && !(may_go && own_mark_is_in(file)))
            FAIL(err, ERROR_INPUT,
                 "%s is there, and nothing says that a run wrote it: choose another folder (-o), "
                 "or move it away",
                 file);
    }
cleanup:
    closedir(directory);
    return error_is_clean(err);
}

// The own file number k / 3, the unfinished one, and what is to replace that; false: no more.
static bool own_path(const char *folder, int32_t k, char path[PATH_SIZE])
{
    static const char *const ends[] = {"", ".part", ".part.part"};
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
        if (!open_is_there(path)) continue;
        if (k % 3 == 0 && !own_mark_is_in(path))
            return REFUSE(err,
                          "%s is there, and is none that a run wrote: choose another folder (-o), "
                          "or move it away",
                          path);
        if (!folder->has_earlier) memcpy(found, path, PATH_SIZE);
        folder->has_earlier = true;
    }
    return true;
}

// Who holds the lock has written so into its file.
static bool take_lock(ResultFolder *folder, Error *err)
{
    char path[PATH_SIZE], host[65] = "", holder[128] = "";
    Error ignored = {0};
    snprintf(path, sizeof path, "%s/%s", folder->path, LOCK_NAME);
    if (file_lock_take(&folder->lock, path, LOCK_WAIT)) {
        gethostname(host, sizeof host - 1);
        dprintf(folder->lock.descriptor, "process %ld on %s\n", (long)getpid(), host);
        return true;
    }
    if (!folder->lock.busy && !open_is_there(path)) return true;   // a file system without locks
    if (!folder->lock.busy)
        return REFUSE(err, "%s is there, and is no lock of ours: move it away", path);
    FILE *file = open_stream(path, &ignored);
    if (file) {
        if (!fgets(holder, sizeof holder, file)) *holder = 0;
        fclose(file);
    }
    holder[strcspn(holder, "\n")] = 0;
    return REFUSE(err,
                  "%s: another computation is writing its result there (%s): choose another folder "
                  "(-o), or wait until it has ended",
                  folder->path, *holder ? holder : "its process is not known");
}

// There is a checkpoint, and no report of a run that came to its end.
static bool may_go_on(const char *folder)
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

// All own files of `folder`, the history last, as the proof.
static bool move_all(const char *folder, const char *to, Error *err)
{
    char path[PATH_SIZE], target[PATH_SIZE] = "";
    if (!move_folder(folder, to, "fields", own_file_is_field, err)) return false;
    if (!move_folder(folder, to, "figures", own_file_is_figure, err)) return false;
    for (int32_t k = 0; own_path(folder, k, path); k++) {
        if (*to) own_path(to, k, target);
        if (!move_file(path, target, err)) return false;
    }
    return true;
}

static bool rename_aside(const char *folder, const char *from, const char *to, Error *err)
{
    char path[PATH_SIZE], target[PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s", folder, from);
    snprintf(target, sizeof target, "%s/%s", folder, to);
    return move_file(path, target, err);
}

// Empties folder/name into `to`, or for good, and removes it.
static bool end_aside(const char *folder, const char *name, const char *to, Error *err)
{
    static const char *const inner[] = {"fields", "figures"};
    char path[PATH_SIZE], sub[PATH_SIZE + 16];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    if (!move_all(path, to, err)) return false;
    for (size_t k = 0; k < sizeof inner / sizeof *inner; k++) {
        snprintf(sub, sizeof sub, "%s/%s", path, inner[k]);
        rmdir(sub);
    }
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

// What a computation that failed, or was killed, has left aside: see above.
static bool put_back(const char *folder, Error *err)
{
    if (is_folder(folder, GONE) && !end_aside(folder, GONE, "", err)) return false;
    if (is_folder(folder, EARLIER)) {
        if (!move_all(folder, "", err)) return false;
        if (!rename_aside(folder, EARLIER, ASIDE, err)) return false;
    }
    return !is_folder(folder, ASIDE) || end_aside(folder, ASIDE, folder, err);
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
    TRY(put_back(path, err));
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

// Also without an earlier result: figures and fields of ours may lie there alone.
bool result_folder_clear(ResultFolder *folder, Error *err)
{
    char path[PATH_SIZE];
    bool any = folder->has_earlier || is_folder(folder->path, "fields") ||
               is_folder(folder->path, "figures");
    if (!folder->ours_may_go || !any) return true;
    snprintf(path, sizeof path, "%s/%s", folder->path, ASIDE);
    if (mkdir(path, 0777) != 0)
        return FAULT(err, ERROR_FILE, "cannot make %s for the earlier result: %s", path,
                     strerror(errno));
    folder->aside = true;
    if (!move_all(folder->path, path, err)) return false;
    if (!rename_aside(folder->path, ASIDE, EARLIER, err)) return false;
    folder->has_earlier = false;
    return true;
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

void amontons_let_go(void)
{
    file_locks_let_go();
}

void result_folder_release(ResultFolder *folder)
{
    Error unseen = {0};   // the next who claims the folder tries again
    if (folder->aside) put_back(folder->path, &unseen);
    file_lock_release(&folder->lock);
    *folder = (ResultFolder){0};
}
