// SPDX-License-Identifier: GPL-2.0-or-later
#include "io/files/folder.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

bool folder_make(const char *path, Error *err)
{
    char part[PATH_MAX];
    struct stat what;
    if (snprintf(part, sizeof part, "%s", path) >= (int)sizeof part)
        return REFUSE(err, "the path of the folder %.80s... is too long", path);
    for (char *slash = part + 1; *slash; slash++) {
        if (*slash != '/') continue;
        *slash = 0;
        mkdir(part, 0777);   // a failure shows when the last one is made
        *slash = '/';
    }
    if (mkdir(part, 0777) != 0 && errno != EEXIST) {
        bool wrong_name = errno == ENAMETOOLONG || errno == ENOTDIR;   // no disk can help it
        return FAULT(err, wrong_name ? ERROR_INPUT : ERROR_FILE, "cannot make the folder %s: %s",
                     path, strerror(errno));
    }
    if (stat(part, &what) == 0 && !S_ISDIR(what.st_mode))
        return REFUSE(
            err, "%s is a file, not a folder: choose another folder (-o), or move it away", path);
    return true;
}

// Both by their real paths: one ".." for each name of the folder's that is not the file's too.
void folder_relative(const char *folder, const char *file, char *path, int32_t size)
{
    char from[PATH_MAX + 1], to[PATH_MAX];
    snprintf(path, (size_t)size, "%s", file);
    if (!realpath(folder, from) || !realpath(file, to)) return;
    size_t shared = 0, used = 0;   // bytes, up to the last slash behind which names differ
    if (from[1]) snprintf(from + strlen(from), 2, "/");
    for (size_t k = 0; from[k] && from[k] == to[k]; k++)
        if (from[k] == '/') shared = k + 1;
    for (const char *rest = from + shared; (rest = strchr(rest, '/')); rest++)
        if (used + 3 < (size_t)size) used += (size_t)sprintf(path + used, "../");
    snprintf(path + used, (size_t)size - used, "%s", to + shared);
}

bool folder_beside(const char *file, const char *given, char *path, int32_t size)
{
    const char *slash = file && *given != '/' ? strrchr(file, '/') : NULL;
    int length = slash ? (int)(slash - file) + 1 : 0;
    return snprintf(path, (size_t)size, "%.*s%s", length, slash ? file : "", given) < size;
}
