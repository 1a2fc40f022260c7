// SPDX-License-Identifier: GPL-2.0-or-later
// Where the library lies, and what belongs to it: found from the file that holds this code, so that
// an installed tree may be moved. Called by base/module and run/info/version.
#ifndef AMONTONS_BASE_PLACE_H
#define AMONTONS_BASE_PLACE_H

#include "base/error.h"

#include <stddef.h>

// The folder of the shared library, or of the program or module, that this code is linked into.
bool place_folder(char *folder, size_t size, Error *err);

// The first of `names` ([count], "../share/amontons") below that folder that is there, with the
// folder before it. false: none is; `path` is then empty.
bool place_find(const char *const *names, int32_t count, char *path, size_t size);

#endif
