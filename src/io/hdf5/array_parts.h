// SPDX-License-Identifier: GPL-2.0-or-later
// A long file that is being written lies on the disk in parts: `path`.part.1, .2, ... (whole HDF5
// files that are written once), and `path`.part, the last one, which is replaced as a whole at each
// flush. Every array goes on from part to part: its attribute "first_row" says which row of the
// whole array is its first. Rows that an earlier part has beyond that count no more: the array was
// cut. The last part's attribute "parts" says how many there are before it. Called by
// io/hdf5/array_file_module alone.
#ifndef AMONTONS_IO_HDF5_ARRAY_PARTS_H
#define AMONTONS_IO_HDF5_ARRAY_PARTS_H

#include "io/hdf5/array_series.h"

#include <limits.h>

typedef struct ArrayParts {
    const char *path;   // of the last part, without number; not owned
    hid_t last;   // that part
    int32_t count;   // of parts before it
    bool unnamed;   // number `count` is still called `path`
} ArrayParts;

// The name of part `number`, from 1 on.
void array_part_name(const ArrayParts *parts, int32_t number, char name[PATH_MAX + 24]);

// How many parts the file `last` says there are before it; ERROR_FILE: nothing that can be.
bool array_parts_count(hid_t last, const char *path, int32_t *count, Error *err);

// All rows of an array as doubles: *values [rows * width], the caller's (memory_free).
bool array_parts_read(const ArrayParts *parts, const char *name, double **values, int64_t *rows,
                      int32_t *width, Error *err);

// Makes the arrays and attributes of the file `from` in the file `to`, without rows. goes_on: `to`
// is the part after it.
bool array_parts_begin(hid_t from, hid_t to, bool goes_on, const char *path, Error *err);

// Writes all arrays whole into the file `whole`.
bool array_parts_join(const ArrayParts *parts, hid_t whole, Error *err);

#endif
