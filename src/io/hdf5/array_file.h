// SPDX-License-Identifier: GPL-2.0-or-later
// Named arrays in one HDF5 file: growing time series, fixed arrays, attributes. Knows nothing of
// friction; io/hdf5/result_file gives the arrays their names. Chunked, shuffled, deflate 2. HDF5 is
// in a module (io/hdf5/array_file_module), opened with the first file; ERROR_LIBRARY where it
// cannot be had.
//
// A file being written is in memory; array_file_flush puts all of it on the disk, as `path`.part,
// and array_file_close renames that. What a killed run leaves is the .part file, readable as of the
// last flush. A flush that fails (ERROR_FILE: full disk, quota) leaves the one before.
#ifndef AMONTONS_IO_HDF5_ARRAY_FILE_H
#define AMONTONS_IO_HDF5_ARRAY_FILE_H

#include "base/error.h"

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

typedef struct ArrayFile ArrayFile;   // begins with a pointer to its module's table

ArrayFile *array_file_create(const char *path, Error *err);
// Opens `path` for reading; where only `path`.part stands, that. Errors name the file.
ArrayFile *array_file_open(const char *path, Error *err);
// Opens a file of array_file_create to go on with, finished or not: it is called `path`.part again.
// A series of it can be cut and appended to when it is taken up (array_file_take_up).
ArrayFile *array_file_reopen(const char *path, Error *err);
// Closes; a created file gets its final name, unless a write failed: then the .part stays. Frees
// `file` either way. NULL is fine.
bool array_file_close(ArrayFile *file, Error *err);
// Closes without a final name: what was appended stays in `path`.part. NULL is fine.
void array_file_abandon(ArrayFile *file);

// An empty series.
bool array_file_add_series(ArrayFile *file, const ArraySeries *series, Error *err);
// Adds an empty series of vectors. Their components are the last axis,
// [rows][width / components][components].
bool array_file_add_vectors(ArrayFile *file, const ArraySeries *series, int32_t components,
                            Error *err);

// Appends `rows` rows of doubles, [rows * width], converted to the stored type (integers: the
// nearest that fits, 0 for NaN). Cheap for single rows, and allocates no arrays.
bool array_file_append(ArrayFile *file, const char *name, const double *values, int64_t rows,
                       Error *err);
// A series with all its rows. stride: doubles from one row to the next; 0: they stand without gaps.
bool array_file_write(ArrayFile *file, const ArraySeries *series, const double *values,
                      int32_t stride, int64_t rows, Error *err);
// A reader finds all that was appended so far, also after a kill or a power cut. It takes as long
// as the whole file needs to reach the disk; where nothing has changed since, no time.
bool array_file_flush(ArrayFile *file, Error *err);
// Takes up a series that a reopened file has, which may be anybody's. ERROR_INPUT: its type, width
// or components are not these. ERROR_FILE: there is none.
bool array_file_take_up(ArrayFile *file, const ArraySeries *series, int32_t components, Error *err);
// Keeps only the first `rows` rows of a series that was added or taken up. ERROR_FILE: it has
// fewer, or there is none.
bool array_file_cut(ArrayFile *file, const char *name, int64_t rows, Error *err);
// The array or attribute `name`, where there is one; no series that was appended to.
bool array_file_remove(ArrayFile *file, const char *name, Error *err);

bool array_file_set_number(ArrayFile *file, const char *name, double value, Error *err);
bool array_file_set_text(ArrayFile *file, const char *name, const char *value, Error *err);
bool array_file_get_number(ArrayFile *file, const char *name, double *value, Error *err);
bool array_file_get_text(ArrayFile *file, const char *name, char *value, int32_t size, Error *err);

// A whole dataset as doubles: *values [rows * width], components the fastest, owned by the caller
// (memory_free).
bool array_file_read(ArrayFile *file, const char *name, double **values, int64_t *rows,
                     int32_t *width, Error *err);
bool array_file_has(ArrayFile *file, const char *name);

// --- the module ---------------------------------------------------------------------------------

// The module amontons_hdf5.so does these calls by HDF5. It is a module because Debian's HDF5 loads
// 40 libraries (curl, ssl, kerberos ...), which takes longer than all else that a short run does
// outside its time loop.

// The calls above on a file, with their arguments: X(name, types, names).
#define ARRAY_FILE_CALLS(X)                                                                        \
    X(add_vectors, (ArrayFile * file, const ArraySeries *series, int32_t components, Error *err),  \
      (file, series, components, err))                                                             \
    X(append,                                                                                      \
      (ArrayFile * file, const char *name, const double *values, int64_t rows, Error *err),        \
      (file, name, values, rows, err))                                                             \
    X(flush, (ArrayFile * file, Error * err), (file, err))                                         \
    X(take_up, (ArrayFile * file, const ArraySeries *series, int32_t components, Error *err),      \
      (file, series, components, err))                                                             \
    X(cut, (ArrayFile * file, const char *name, int64_t rows, Error *err),                         \
      (file, name, rows, err))                                                                     \
    X(remove, (ArrayFile * file, const char *name, Error *err), (file, name, err))                 \
    X(set_number, (ArrayFile * file, const char *name, double value, Error *err),                  \
      (file, name, value, err))                                                                    \
    X(set_text, (ArrayFile * file, const char *name, const char *value, Error *err),               \
      (file, name, value, err))                                                                    \
    X(get_number, (ArrayFile * file, const char *name, double *value, Error *err),                 \
      (file, name, value, err))                                                                    \
    X(get_text, (ArrayFile * file, const char *name, char *value, int32_t size, Error *err),       \
      (file, name, value, size, err))                                                              \
    X(read,                                                                                        \
      (ArrayFile * file, const char *name, double **values, int64_t *rows, int32_t *width,         \
       Error *err),                                                                                \
      (file, name, values, rows, width, err))                                                      \
    X(has, (ArrayFile * file, const char *name), (file, name))

// The calls above; no `file` is NULL.
typedef struct ArrayFileModule {
    ArrayFile *(*create)(const char *path, Error *err);
    ArrayFile *(*open)(const char *path, Error *err);
    ArrayFile *(*reopen)(const char *path, Error *err);
    bool (*close)(ArrayFile *file, Error *err);   // frees `file` either way
    void (*abandon)(ArrayFile *file);
#define X(name, types, names) bool(*name) types;
    ARRAY_FILE_CALLS(X)
#undef X
} ArrayFileModule;

// The module's one entry, "amontons_array_file_module": a table that lasts as long as the program.
typedef const ArrayFileModule *(*ArrayFileModuleFunction)(void);
const ArrayFileModule *amontons_array_file_module(void);

#endif
