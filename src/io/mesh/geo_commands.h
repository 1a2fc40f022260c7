// SPDX-License-Identifier: GPL-2.0-or-later
// A .geo is a program: gmsh would run commands that stand in it and write files. A scene from a
// stranger must be safe to look at, so such a file is refused before gmsh sees it, unless the user
// has said that it may be trusted (`--trust`, or the variable AMONTONS_TRUST). Called by
// io/mesh/mesh_read.
#ifndef AMONTONS_IO_MESH_GEO_COMMANDS_H
#define AMONTONS_IO_MESH_GEO_COMMANDS_H

#include "base/error.h"

#include <stdbool.h>

// ERROR_INPUT, with file and line: `path` (a .geo: is_script), a file that it includes, or the
// options beside it (FILE.opt) runs a command, writes a file, or opens another one that was not
// looked at.
bool geo_commands_refuse(const char *path, bool is_script, Error *err);

#endif
