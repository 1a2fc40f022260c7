// SPDX-License-Identifier: GPL-2.0-or-later
// A mesh with fields, as io/fields/field_file takes it and the VTK module
// (io/fields/field_file_module) gets it.
#ifndef AMONTONS_IO_FIELDS_FIELD_GRID_H
#define AMONTONS_IO_FIELDS_FIELD_GRID_H

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
    const double *points;   // [point_count * 3]
    int64_t cell_count;
    const int64_t *offsets;   // [cell_count + 1] into connectivity
    const int64_t *connectivity;   // VTK's node order
    const uint8_t *cell_types;   // [cell_count] VTK's numbers (9 quad, 23 quadratic quad, ...)
    double time;   // stored as the field TimeValue
    int32_t point_array_count;
    const FieldArray *point_arrays;
} FieldGrid;

#endif
