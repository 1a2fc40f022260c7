// SPDX-License-Identifier: GPL-2.0-or-later
// Interface of the module amontons_vtk.so: VTK's XML writers turn a grid into the bytes of a file,
// and its reader turns a file into arrays. The bytes are written by io/fields/field_file, which can
// say why a write failed; VTK cannot.
#ifndef AMONTONS_IO_FIELDS_FIELD_FILE_MODULE_H
#define AMONTONS_IO_FIELDS_FIELD_FILE_MODULE_H

#include "base/error.h"
#include "io/fields/field_grid.h"

typedef enum FieldFormat { FIELD_VTU, FIELD_VTP } FieldFormat;

// Takes the bytes of a whole file, which it does not own; false: it failed, and set the error.
typedef bool (*FieldSink)(void *context, const char *bytes, int64_t size, Error *err);

typedef struct FieldOutput {
    FieldFormat format;
    FieldSink sink;
    void *context;   // handed to sink
} FieldOutput;

// The module's first entry, "amontons_vtk_encode". The grid must be valid (io/fields/field_file
// checks).
typedef bool (*FieldEncodeFunction)(const FieldGrid *grid, const FieldOutput *output, Error *err);

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
