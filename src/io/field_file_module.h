// SPDX-License-Identifier: GPL-2.0-or-later
// What the module amontons_vtk.so offers: VTK's XML writers turn a grid into the bytes of a file.
// The bytes are written by io/field_file, which can say why a write failed; VTK cannot.
#ifndef AMONTONS_IO_FIELD_FILE_MODULE_H
#define AMONTONS_IO_FIELD_FILE_MODULE_H

#include "base/error.h"
#include "io/field_grid.h"

typedef enum FieldFormat { FIELD_VTU, FIELD_VTP } FieldFormat;

// Takes the bytes of a whole file, which it does not own; false: it failed, and set the error.
typedef bool (*FieldSink)(void *context, const char *bytes, int64_t size, Error *err);

typedef struct FieldOutput {
    FieldFormat format;
    FieldSink sink;
    void *context;   // handed to sink
} FieldOutput;

// The module's one entry, "amontons_vtk_encode". The grid must be valid (io/field_file checks).
typedef bool (*FieldEncodeFunction)(const FieldGrid *grid, const FieldOutput *output, Error *err);

#endif
