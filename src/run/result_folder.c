// SPDX-License-Identifier: GPL-2.0-or-later
// Makes room for results: the folder is made with all that leads to it, and files of an earlier
// result are removed by name, those in fields/ and figures/ by their endings; what else lies there
// stays. run.json goes first, so that a run that is killed from here on leaves no report of the one
// before.
#include "run/result_folder.h"

#include <dirent.h>
#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { PATH_SIZE = PATH_MAX + 300 };

// What a run leaves, in the order in which it is removed.
static const char *const OWN_FILES[] = {
    "run.json",       "run.json.part",       "history.h5",   "history.h5.part",
    "fields.pvd",     "fields.pvd.part",     "static.json",  "static.json.part",
    "static.h5",      "static.h5.part",      "static.vtu",   "static.vtu.part",
    "stability.json", "stability.json.part", "stability.h5", "stability.h5.part",
    "model1d.json",   "model1d.json.part",   "model1d.h5",   "model1d.h5.part"};
static const char *const OWN_FOLDERS[] = {"fields", "figures"};
static const char *const OWN_ENDINGS[] = {".vtu", ".vtp", ".png", ".part"};

// Like `mkdir -p`, but a file in its place or a folder that cannot be written to is told at once.
static bool make_folder(const char *folder, Error *err)
{
    char path[PATH_MAX];
    if (snprintf(path, sizeof path, "%s", folder) >= (int)sizeof path)
        FAIL(err, ERROR_INPUT, "the path of the result folder is too long");
    for (char *slash = path + 1; *slash; slash++) {
        if (*slash != '/') continue;
        *slash = 0;
        mkdir(path, 0777);   // a failure shows when the last one is made
        *slash = '/';
    }
    if (mkdir(path, 0777) != 0 && errno != EEXIST)
        FAIL(err, ERROR_FILE, "cannot make the result folder %s: %s", folder, strerror(errno));
    struct stat what;
    if (stat(path, &what) != 0 || !S_ISDIR(what.st_mode))
        FAIL(err, ERROR_FILE, "%s is a file, not a folder: choose another result folder (-o)",
             folder);
    if (access(path, W_OK | X_OK) != 0)
        FAIL(err, ERROR_FILE, "cannot write into %s: %s", folder, strerror(errno));
cleanup:
    return error_is_clean(err);
}

// Files in fields/ and figures/: by their ending, as their names are numbered.
static bool is_own(const char *name)
{
    const char *dot = strrchr(name, '.');
    for (size_t k = 0; dot && k < sizeof OWN_ENDINGS / sizeof OWN_ENDINGS[0]; k++) {
        if (strcmp(dot, OWN_ENDINGS[k]) == 0) return true;
    }
    return false;
}

static bool remove_file(const char *folder, const char *name, Error *err)
{
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    if (unlink(path) != 0 && errno != ENOENT)
        FAIL(err, ERROR_FILE, "cannot remove the earlier result %s: %s", path, strerror(errno));
cleanup:
    return error_is_clean(err);
}

static bool empty_folder(const char *folder, const char *name, Error *err)
{
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    DIR *directory = opendir(path);
    if (!directory) return true;
    for (struct dirent *entry = readdir(directory); entry; entry = readdir(directory)) {
        if (is_own(entry->d_name)) TRY(remove_file(path, entry->d_name, err));
    }
cleanup:
    closedir(directory);
    return error_is_clean(err);
}

// ERROR_INPUT: there is a result and `overwrite` is false; nothing was touched then.
bool result_folder_prepare(const char *folder, bool overwrite, Error *err)
{
    char path[PATH_SIZE];
    TRY(make_folder(folder, err));
    for (size_t k = 0; k < sizeof OWN_FILES / sizeof OWN_FILES[0]; k++) {
        snprintf(path, sizeof path, "%s/%s", folder, OWN_FILES[k]);
        if (!overwrite && access(path, F_OK) == 0)
            FAIL(err, ERROR_INPUT,
                 "%s holds an earlier result (%s): choose another folder (-o) or say --overwrite",
                 folder, OWN_FILES[k]);
        TRY(remove_file(folder, OWN_FILES[k], err));
    }
    for (size_t k = 0; k < sizeof OWN_FOLDERS / sizeof OWN_FOLDERS[0]; k++)
        TRY(empty_folder(folder, OWN_FOLDERS[k], err));
cleanup:
    return error_is_clean(err);
}
