// SPDX-License-Identifier: GPL-2.0-or-later
// Types that io/hdf5/array_file and the HDF5 module (io/hdf5/array_file_module) share.
#ifndef AMONTONS_IO_HDF5_ARRAY_TYPES_H
#define AMONTONS_IO_HDF5_ARRAY_TYPES_H

#include <stdint.h>

enum { ARRAY_RANK_MAX = 3 };

typedef enum ArrayType { ARRAY_FLOAT64, ARRAY_FLOAT32, ARRAY_UINT8, ARRAY_INT32 } ArrayType;

// A series of rows of `width` values (1: a scalar series), extendable, empty. `name` may hold
// slashes ("interface/slip_rate"); `unit` and `description` are stored as attributes.
typedef struct ArraySeries {
    const char *name;
    ArrayType type;   // as stored
    int32_t width;
    const char *unit;
    const char *description;
} ArraySeries;

#endif
