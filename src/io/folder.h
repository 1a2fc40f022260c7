// SPDX-License-Identifier: GPL-2.0-or-later
// Makes folders. Called by whoever writes files.
#ifndef AMONTONS_IO_FOLDER_H
#define AMONTONS_IO_FOLDER_H

#include "base/error.h"

// Like `mkdir -p`: `path` and all that leads there; what is there already is left as it is.
bool folder_make(const char *path, Error *err);

#endif
