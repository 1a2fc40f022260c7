// SPDX-License-Identifier: GPL-2.0-or-later
// Files of an earlier result go by their full names: those below, the numbered ones in fields/ and
// the figures that exist, and only where one of the first proves that the folder holds a result of
// ours; where none does, a file of such a name is somebody's, and a run that would write over it is
// refused. A link in the place of fields/ or figures/ is not followed when files are removed.
// run.json and the checkpoint go first, so that a run that is killed from here on leaves neither a
// report of the one before nor half of it to go on with; the history goes last, as the proof.
#include "run/result_folder.h"

#include "io/folder.h"
#include "render/render.h"

#include <ctype.h>
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

// What proves a result, in the order in which it is removed; each also with the ends of own_path.
static const char *const OWN_FILES[] = {
    "run.json",   CHECKPOINT_FILE,  "history.h5",   "fields.pvd",   "static.json", "static.h5",
    "static.vtu", "stability.json", "stability.h5", "model1d.json", "model1d.h5",  "report.html"};
enum { OWN_FILE_COUNT = sizeof OWN_FILES / sizeof OWN_FILES[0] };

#define FIGURE_FILE(id, name, words) name ".png", name ".pdf", name ".svg",
#define FIELD_FILE(id, name, ...) FIGURE_FILE(id, "field-" name, )   // of a quantity
static const char *const FIGURES[] = {
    RENDER_FIGURES(FIGURE_FILE) BLOCK_QUANTITIES(FIELD_FILE) "accuracy.png", "accuracy.json"};

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

static bool is_figure(const char *name)
{
    for (size_t k = 0; k < sizeof FIGURES / sizeof FIGURES[0]; k++)
        if (strcmp(FIGURES[k], name) == 0) return true;
    return false;
}

// bulk_000012.vtu, interface_000012.vtp (record/fields).
static bool is_field(const char *name)
{
    static const char *const starts[] = {"bulk_", "interface_"}, *const ends[] = {".vtu", ".vtp"};
    for (int kind = 0; kind < 2; kind++) {
        size_t length = strlen(starts[kind]), digits = 0;
        if (strncmp(name, starts[kind], length) != 0) continue;
        while (isdigit((unsigned char)name[length + digits])) digits++;
        if (digits >= 6 && strcmp(name + length + digits, ends[kind]) == 0) return true;
    }
    return false;
}

// The own files of folder/name, told by `is_own`. A folder that is not there, or a link, is left.
static bool empty_folder(const char *folder, const char *name, bool (*is_own)(const char *),
                         Error *err)
{
    char path[PATH_SIZE], bare[NAME_MAX + 1];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    int opened = open(path, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    DIR *directory = opened < 0 ? NULL : fdopendir(opened);
    if (!directory) return true;
    for (struct dirent *entry = readdir(directory); entry; entry = readdir(directory)) {
        strip_part(entry->d_name, bare);
        if (is_own(bare) && unlinkat(opened, entry->d_name, 0) != 0 && errno != ENOENT)
            FAIL(err, ERROR_FILE, "cannot remove the earlier result %s/%s: %s", path, entry->d_name,
                 strerror(errno));
    }
cleanup:
    closedir(directory);
    return error_is_clean(err);
}

// Nobody's run has written into the folder: what has the name of a field or a figure is somebody's.
// (accuracy.json is what a stopped search for an error bar leaves, alone.)
static bool refuse_taken(const char *folder, const char *name, bool (*is_own)(const char *),
                         Error *err)
{
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    DIR *directory = opendir(path);
    if (!directory) return true;
    for (struct dirent *entry = readdir(directory); entry; entry = readdir(directory))
        if (is_own(entry->d_name) && strncmp(entry->d_name, "accuracy.", 9) != 0)
            FAIL(err, ERROR_INPUT,
                 "%s/%s is there, and no result beside it says that a run wrote it: choose another "
                 "folder (-o), or move it away",
                 path, entry->d_name);
cleanup:
    closedir(directory);
    return error_is_clean(err);
}

// folder/OWN_FILES[k / 3], the unfinished file, and its journal (io/array_journal).
static void own_path(const char *folder, int k, char path[PATH_SIZE])
{
    static const char *const ends[] = {"", ".part", ".journal"};
    snprintf(path, PATH_SIZE, "%s/%s%s", folder, OWN_FILES[k / 3], ends[k % 3]);
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
    snprintf(path, sizeof path, "%s/%s", folder, OWN_FILES[0]);
    FILE *report = fopen(path, "r");
    if (!report) return true;
    start[fread(start, 1, sizeof start - 1, report)] = 0;
    fclose(report);
    return !strstr(start, "\"done\"");
}

bool result_folder_claim(const char *path, bool overwrite, ResultFolder *folder, Error *err)
{
    char found[PATH_SIZE];
    bool begun = false;   // by a run that was killed before it kept anything
    *folder = (ResultFolder){0};
    if (!path) return true;
    TRY(make_folder(path, err));
    if (strlen(path) >= sizeof folder->path)
        FAIL(err, ERROR_INPUT, "the path of the result folder is too long");
    memcpy(folder->path, path, strlen(path) + 1);
    snprintf(found, sizeof found, "%s/%s", path, LOCK_NAME);
    begun = access(found, F_OK) == 0;
    TRY(take_lock(folder, err));
    for (int k = 0; k < 3 * OWN_FILE_COUNT && !folder->has_earlier; k++) {
        own_path(path, k, found);
        folder->has_earlier = access(found, F_OK) == 0;
    }
    if (folder->has_earlier && !overwrite && may_go_on(path))
        FAIL(err, ERROR_INPUT,
             "%s holds a result that was cut off: go on with it (--resume), choose another folder "
             "(-o) or say --overwrite",
             path);
    if (folder->has_earlier && !overwrite)
        FAIL(err, ERROR_INPUT,
             "%s holds an earlier result (%s): choose another folder (-o) or say --overwrite", path,
             strrchr(found, '/') + 1);
    if (!folder->has_earlier && !begun) {
        TRY(refuse_taken(path, "fields", is_field, err));
        TRY(refuse_taken(path, "figures", is_figure, err));
    }
cleanup:
    if (!error_is_clean(err)) result_folder_release(folder);
    return error_is_clean(err);
}

// OWN_FILES from one up to another.
static bool remove_files(const char *folder, int from, int end, Error *err)
{
    char path[PATH_SIZE];
    for (int k = 3 * from; k < 3 * end; k++) {
        own_path(folder, k, path);
        if (unlink(path) != 0 && errno != ENOENT)
            FAIL(err, ERROR_FILE, "cannot remove the earlier result %s: %s", path, strerror(errno));
    }
cleanup:
    return error_is_clean(err);
}

bool result_folder_clear(ResultFolder *folder, Error *err)
{
    enum { STATUS_FILES = 2 };   // report and checkpoint
    if (!folder->has_earlier) return true;
    TRY(remove_files(folder->path, 0, STATUS_FILES, err));
    TRY(empty_folder(folder->path, "fields", is_field, err));
    TRY(empty_folder(folder->path, "figures", is_figure, err));
    TRY(remove_files(folder->path, STATUS_FILES, OWN_FILE_COUNT, err));
    folder->has_earlier = false;
cleanup:
    return error_is_clean(err);
}

bool result_folder_take_up(ResultFolder *folder, Error *err)
{
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s", folder->path, OWN_FILES[0]);
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
