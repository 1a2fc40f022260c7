// SPDX-License-Identifier: GPL-2.0-or-later
// The parameters a .geo takes: the names in its DefineConstant[ ... ] lists. Read from the text,
// because gmsh ignores a value for an unknown name. Called by io/mesh/mesh_read.
#ifndef AMONTONS_IO_MESH_GEO_PARAMETERS_H
#define AMONTONS_IO_MESH_GEO_PARAMETERS_H

#include "base/error.h"
#include "io/mesh/mesh_file.h"

#include <limits.h>
#include <stdint.h>

// GEO_FILES_MAX: files that include the next one twice each would be read 2^depth times.
// GEO_BYTES_MAX: of all of them.
enum {
    GEO_INCLUDE_DEPTH_MAX = 8,
    GEO_FILES_MAX = 1000,
    GEO_PATH_SIZE = 2 * PATH_MAX,
    GEO_BYTES_MAX = 1 << 28
};

// The file that `Include "name"` means in the script `path`: `name`, of which `length` bytes count,
// is relative to it.
void geo_included_path(const char *path, const char *name, int length,
                       char included[GEO_PATH_SIZE]);

typedef struct GeoParameter {
    char name[GROUP_NAME_SIZE];
    bool is_text;   // its default is a string
} GeoParameter;

typedef struct GeoParameters {
    int32_t count, room;
    GeoParameter *items;   // [count] in the order of the file; owned
} GeoParameters;

// Reads `path` and the files it includes (`Include "other.geo";`). *known is destroyed by the
// caller. ERROR_INPUT: a file that cannot be read; includes that are nested deeper than 8, or are
// too many or too large.
bool geo_parameters_read(const char *path, GeoParameters *known, Error *err);
void geo_parameters_destroy(GeoParameters *known);

// ERROR_INPUT for one of `given` [given_count] that the .geo does not know (lists those it knows),
// is given twice, has the other type, is not finite, or has a text that gmsh cannot quote.
bool geo_parameters_check(const GeoParameters *known, const char *path, const MeshParameter *given,
                          int32_t given_count, Error *err);

#endif
