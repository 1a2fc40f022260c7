// SPDX-License-Identifier: GPL-2.0-or-later
// Fields on a mesh for ParaView: .vtu (bulk), .vtp (the interface as lines) and the .pvd that lists
// them against time. Written by VTK's own XML writers, in a module opened on first use: appended,
// compressed (zlib level 1), 64-bit headers. Called by record/fields.
#ifndef AMONTONS_IO_FIELD_FILE_H
#define AMONTONS_IO_FIELD_FILE_H

#include "base/error.h"

#include <stdint.h>

// One array over points or cells. Values are not copied and not owned.
typedef struct FieldArray {
    const char *name;   // "displacement"; units go into the README's table, not the name
    int32_t components;   // 1, or 3 for vectors (ParaView wants three)
    bool single_precision;   // stored as Float32 (default: Float64)
    const double *values;   // [count * components]
} FieldArray;

// A mesh with fields. Arrays are not copied and not owned; indices from 0.
typedef struct FieldGrid {
    int64_t point_count;
    const double *points;   // [point_count * 3]
    int64_t cell_count;
    const int64_t *offsets;   // [cell_count + 1] into connectivity
    const int64_t *connectivity;   // VTK's node order
    const uint8_t *cell_types;   // [cell_count] VTK's numbers (9 quad, 23 quadratic quad, ...)
    double time;   // stored as the field TimeValue
    int32_t point_array_count;
    const FieldArray *point_arrays;
    int32_t cell_array_count;
    const FieldArray *cell_arrays;
} FieldGrid;

// Both write beside `path` and rename, so a half file never stands under the final name. Errors
// (ERROR_FILE) name the path and the cause (full disk, no permission, no such folder).
bool field_file_write_vtu(const char *path, const FieldGrid *grid, Error *err);
bool field_file_write_vtp(const char *path, const FieldGrid *grid, Error *err);   // cells: lines

typedef struct FieldSeriesEntry {
    double time;
    const char *part;   // "bulk" or "interface"
    const char *file;   // relative to the .pvd
} FieldSeriesEntry;

// Writes the collection anew (atomic); entries of equal time may differ in `part`.
bool field_file_write_pvd(const char *path, const FieldSeriesEntry *entries, int32_t count,
                          Error *err);

#endif
