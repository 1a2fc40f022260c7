// SPDX-License-Identifier: GPL-2.0-or-later
// The loader knows the path of every shared object but the program's own, which has an empty name.
#include "base/place.h"

#include <dlfcn.h>
#include <libgen.h>
#include <limits.h>
#include <link.h>
#include <stdio.h>
#include <unistd.h>

bool place_folder(char *folder, size_t size, Error *err)
{
    static const char here = 0;   // an address in this object
    char path[PATH_MAX] = {0};
    Dl_info info;
    void *map = NULL;
    bool is_library = dladdr1(&here, &info, &map, RTLD_DL_LINKMAP) != 0 && map &&
                      ((const struct link_map *)map)->l_name[0];
    if (is_library)
        snprintf(path, sizeof path, "%s", ((const struct link_map *)map)->l_name);
    else if (readlink("/proc/self/exe", path, sizeof path - 1) < 0)
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
