// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/place.h"

#include "base/system.h"

#include <libgen.h>
#include <limits.h>
#include <stdio.h>
#include <unistd.h>

bool place_folder(char *folder, size_t size, Error *err)
{
    static const char here = 0;   // an address in this object
    char path[PATH_MAX] = {0};
    if (!system_object_path(&here, path, sizeof path) && !system_program_path(path, sizeof path))
        return FAULT(err, ERROR_LIBRARY, "cannot tell where the program stands (/proc/self/exe)");
    snprintf(folder, size, "%s", dirname(path));
    return true;
}

bool place_find(const char *const *names, int32_t count, char *path, size_t size)
{
    Error unseen = {0};   // no folder: nothing is found in it
    char folder[PATH_MAX] = {0};
    path[0] = 0;
    if (!place_folder(folder, sizeof folder, &unseen)) return false;
    for (int32_t k = 0; k < count; k++) {
        int length = snprintf(path, size, "%s/%s", folder, names[k]);
        if (length > 0 && (size_t)length < size && access(path, F_OK) == 0) return true;
    }
    path[0] = 0;
    return false;
}
