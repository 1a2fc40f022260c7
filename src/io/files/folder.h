// SPDX-License-Identifier: GPL-2.0-or-later
// Makes folders, and says where a file is as seen from one.
#ifndef AMONTONS_IO_FILES_FOLDER_H
#define AMONTONS_IO_FILES_FOLDER_H

#include "base/error.h"

// Like `mkdir -p`: `path` and all that leads there; what is there already is left as it is.
// ERROR_INPUT: `path` is a file, or leads through one.
bool folder_make(const char *path, Error *err);

// `given` as seen from the folder of `file` (NULL: the working folder). false: there is no room.
bool folder_beside(const char *file, const char *given, char *path, int32_t size);

// `file` as seen from `folder`: "../../meshes/block.geo" from results/fig1. As it is where one of
// them does not exist.
void folder_relative(const char *folder, const char *file, char *path, int32_t size);

#endif
