// SPDX-License-Identifier: GPL-2.0-or-later
// Version of this library, the places of the files that come with it, and how it uses its process.
#include "amontons.h"
#include "base/child_process.h"
#include "base/kernels.h"
#include "base/system.h"
#include "build_record.h"

#include <libgen.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

const char *amontons_version(void)
{
    return AMONTONS_VERSION;
}

const char *amontons_revision(void)
{
    return BUILD_REVISION;
}

const char *amontons_libraries(void)
{
    return BUILD_LIBRARIES;
}

const char *amontons_kernels(const char **possible)
{
    const char *name = kernels_name(), *best = kernels_possible();
    *possible = strcmp(name, best) == 0 ? NULL : best;
    return name;
}

void amontons_use_child_processes(bool use)
{
    child_use(use);
}

// Installed, or the source folder above build/bin.
bool amontons_data_folder(char folder[AMONTONS_PATH_SIZE])
{
    static const char *const places[] = {AMONTONS_DATA_FROM_LIBRARY "/meshes/block.geo",
                                         "../../meshes/block.geo"};
    char found[AMONTONS_PATH_SIZE], whole[PATH_MAX];
    if (!system_find(places, 2, found, sizeof found) || !realpath(found, whole)) return false;
    int length = snprintf(folder, AMONTONS_PATH_SIZE, "%s", dirname(dirname(whole)));
    return length < AMONTONS_PATH_SIZE;
}
