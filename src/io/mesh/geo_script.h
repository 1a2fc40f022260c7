// SPDX-License-Identifier: GPL-2.0-or-later
// A .geo is a program in gmsh's language, which can run commands, write files and open others. A
// scene from a stranger must be safe to look at, so a .geo that was not said to be trusted is read
// here first, as gmsh's own scanner would read it: every word of it must be on the list of those
// that make geometry and meshes. gmsh is then given the text that was looked at, and not the file.
// Called by io/mesh/mesh_read.
#ifndef AMONTONS_IO_MESH_GEO_SCRIPT_H
#define AMONTONS_IO_MESH_GEO_SCRIPT_H

#include "base/error.h"

#include <stdint.h>

// A line of the text where another file begins or goes on.
typedef struct GeoPlace {
    int32_t line;   // of the text, from 1
    int32_t file, file_line;   // its file; the line of that file, from 1
} GeoPlace;

typedef struct GeoScript {
    char *text;   // [size + 1] zero-terminated; owned
    int32_t size;
    int32_t file_count, file_room;
    char **files;   // [file_count] paths: the .geo itself, and what it includes; owned
    int32_t place_count, place_room;
    GeoPlace *places;   // [place_count] ascending; owned
} GeoScript;

// Reads the .geo `path`. The text has its statements, and those of the files that it includes or
// merges, where these stand; comments, and statements that only show or write (Printf, Save, the
// options General.*, View[0].*, ...) are blanks. *script is destroyed by the caller. ERROR_INPUT,
// with file and line: a word that is not on the list, a file that cannot be read, includes too
// deep.
bool geo_script_read(const char *path, GeoScript *script, Error *err);
void geo_script_destroy(GeoScript *script);

// Finds the file and line that line `line` of the text comes from; *path is the script's.
void geo_script_place(const GeoScript *script, int32_t line, const char **path, int32_t *file_line);

#endif
