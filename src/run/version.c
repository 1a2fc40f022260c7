// SPDX-License-Identifier: GPL-2.0-or-later
// What this library is, and where what comes with it lies.
#include "amontons.h"
#include "base/place.h"
#include "build_record.h"

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

// Installed, or the source folder above build/bin.
bool amontons_data_folder(char folder[AMONTONS_PATH_SIZE])
{
    static const char *const places[] = {AMONTONS_DATA_FROM_LIBRARY "/meshes/block.geo",
                                         "../../meshes/block.geo"};
    enum { BEHIND = sizeof "/meshes/block.geo" - 1 };
    if (!place_find(places, 2, folder, AMONTONS_PATH_SIZE)) return false;
    folder[strlen(folder) - BEHIND] = 0;
    return true;
}
