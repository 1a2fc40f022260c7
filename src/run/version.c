// SPDX-License-Identifier: GPL-2.0-or-later
// What this library is, and where what comes with it lies.
#include "amontons.h"
#include "base/place.h"
#include "build_record.h"

#include <libgen.h>
#include <limits.h>
#include <stdio.h>
#include <stdlib.h>

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

// Installed, or the source folder above build/bin.
bool amontons_data_folder(char folder[AMONTONS_PATH_SIZE])
{
    static const char *const places[] = {AMONTONS_DATA_FROM_LIBRARY "/meshes/block.geo",
                                         "../../meshes/block.geo"};
    char found[AMONTONS_PATH_SIZE], whole[PATH_MAX];
    if (!place_find(places, 2, found, sizeof found) || !realpath(found, whole)) return false;
    int length = snprintf(folder, AMONTONS_PATH_SIZE, "%s", dirname(dirname(whole)));
    return length < AMONTONS_PATH_SIZE;
}
