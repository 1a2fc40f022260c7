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

// --- inside of a folder of ours ------------------------------------------------------------------

// What lies inside a folder of ours is found without following a link. The folder of a result or of
// a sweep may come from a stranger: links in it, and names that its files give, could lead to any
// file of the user's. The folder itself, `root`, was named by the user, and may be a link. `name`
// is seen from there: "figures/force.png", "figures/../sweep.h5".

// Checks that `name` may be opened. ERROR_INPUT: one of its parts is a symbolic link, or it is
// absolute, or leads above `root`. A name of which nothing is there is fine: who opens it says so.
bool folder_check_inside(const char *root, const char *name, Error *err);

// Makes the folder `name` with all that leads there, and `root`. ERROR_INPUT: as above, or a part
// is a file.
bool folder_make_inside(const char *root, const char *name, Error *err);

// The folder `name` ("": `root` itself) as a descriptor for openat, renameat and their kind. make:
// what is missing is made. -1 and errno: ELOOP for a link, EXDEV for a name that leads out.
int folder_open_inside(const char *root, const char *name, bool make);

#endif
