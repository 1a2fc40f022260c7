// SPDX-License-Identifier: GPL-2.0-or-later
// Fields on a mesh for ParaView: .vtu (bulk), .vtp (the interface as lines, in space as polygons)
// and the .pvd that lists them against time. Written by VTK's own XML writers, in a module opened
// on first use: appended, in zlib's blocks (the mesh compressed, values at nodes stored), 64-bit
// headers. Called by record/field_files.
#ifndef AMONTONS_IO_FIELDS_FIELD_FILE_H
#define AMONTONS_IO_FIELDS_FIELD_FILE_H

#include "base/error.h"
#include "io/fields/field_grid.h"

// Cells are elements in a .vtu, all lines or all polygons in a .vtp. Written beside `path` and
// renamed, so that the final name never has half a file. Errors (ERROR_FILE) name the path and the
// cause (full disk, no permission, no such folder).
bool field_file_write(const char *path, const FieldGrid *grid, Error *err);

// Names of the files of time number k, in the folder fields/ beside the .pvd.
#define FIELD_BULK_NAME "bulk_%06d.vtu"
#define FIELD_LINE_NAME "interface_%06d.vtp"

// Writes the collection of both files of each time anew (atomic). times: [count]
bool field_file_write_pvd(const char *path, const double *times, int32_t count, Error *err);

#endif
