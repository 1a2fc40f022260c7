// SPDX-License-Identifier: GPL-2.0-or-later
#include "io/folder.h"

#include <errno.h>
#include <limits.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

bool folder_make(const char *path, Error *err)
{
    char part[PATH_MAX];
    if (snprintf(part, sizeof part, "%s", path) >= (int)sizeof part)
        FAIL(err, ERROR_INPUT, "the path of the folder %.80s... is too long", path);
    for (char *slash = part + 1; *slash; slash++) {
        if (*slash != '/') continue;
        *slash = 0;
        mkdir(part, 0777);   // a failure shows when the last one is made
        *slash = '/';
    }
    if (mkdir(part, 0777) != 0 && errno != EEXIST)
        FAIL(err, ERROR_FILE, "cannot make the folder %s: %s", path, strerror(errno));
cleanup:
    return error_is_clean(err);
}
