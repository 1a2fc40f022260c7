// SPDX-License-Identifier: GPL-2.0-or-later
// Fields on a mesh for ParaView: .vtu (bulk), .vtp (the interface as lines, in space as polygons)
// and the .pvd that lists them against time. Written by VTK's own XML writers, in a module opened
// on first use: appended, in zlib's blocks (the mesh compressed, values at nodes stored), 64-bit
// headers. Called by record/field_files.
#ifndef AMONTONS_IO_FIELDS_FIELD_FILE_H
#define AMONTONS_IO_FIELDS_FIELD_FILE_H

#include "base/error.h"

#include <stdint.h>

// One array over points or cells. Values are not copied and not owned.
typedef struct FieldArray {
    const char *name;   // "displacement"; units go into docs/results.md, not the name
    int32_t components;   // 1, or 3 for vectors (ParaView wants three)
    const double *values;   // [count * components]
} FieldArray;

// A mesh with fields. Arrays are not copied and not owned; indices from 0.
typedef struct FieldGrid {
    int64_t point_count;
    double *points;   // [point_count * 3]
    int64_t cell_count;
    int64_t *offsets;   // [cell_count + 1] into connectivity
    int64_t *connectivity;   // VTK's node order
    uint8_t *cell_types;   // [cell_count] VTK's numbers (9 quad, 23 quadratic quad, ...)
    double time;   // stored as the field TimeValue
    int32_t point_array_count;
    const FieldArray *point_arrays;
} FieldGrid;

// Cells are elements in a .vtu, all lines or all polygons in a .vtp. Written beside `path` and
// renamed, so that the final name never has half a file. Errors (ERROR_FILE) name the path and the
// cause (full disk, no permission, no such folder).
bool field_file_write(const char *path, const FieldGrid *grid, Error *err);

// Names of the files of time number k, in the folder fields/ beside the .pvd.
#define FIELD_BULK_NAME "bulk_%06d.vtu"
#define FIELD_LINE_NAME "interface_%06d.vtp"

// Writes the collection of both files of each time anew (atomic). times: [count]
bool field_file_write_pvd(const char *path, const double *times, int32_t count, Error *err);

// --- the module ---------------------------------------------------------------------------------

// The module amontons_vtk.so: VTK's XML writers turn a grid into the bytes of a file, and its
// reader turns a file into arrays. field_file_write writes the bytes: it can say why that failed,
// VTK cannot.
typedef enum FieldFormat { FIELD_VTU, FIELD_VTP } FieldFormat;

// Takes the bytes of a whole file, which it does not own; false: it failed, and set the error.
typedef bool (*FieldSink)(void *context, const char *bytes, int64_t size, Error *err);

// The module's first entry, "amontons_vtk_encode". context: handed to sink.
typedef bool (*FieldEncodeFunction)(const FieldGrid *grid, FieldFormat format, FieldSink sink,
                                    void *context, Error *err);

// One array of the grid of a .vtu that is read, as numbers.
typedef struct FieldPart {
    const char *name;   // of a point array; "points", "offsets", "connectivity" or "types"
    int32_t components;
    int64_t count;   // tuples
    const double *values;   // [count * components] valid during the call
} FieldPart;

typedef bool (*FieldTake)(void *context, const FieldPart *part, Error *err);

// The other one, "amontons_vtk_decode": hands each array of the grid in `path` to `take`.
typedef bool (*FieldDecodeFunction)(const char *path, FieldTake take, void *context, Error *err);

#endif
