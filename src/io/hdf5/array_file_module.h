// SPDX-License-Identifier: GPL-2.0-or-later
// Interface of the module amontons_hdf5.so: the types and calls of io/hdf5/array_file.h, done by
// HDF5. It is a module because Debian's HDF5 loads 40 libraries (curl, ssl, kerberos ...), which
// takes longer than all else that a short run does outside its time loop.
#ifndef AMONTONS_IO_HDF5_ARRAY_FILE_MODULE_H
#define AMONTONS_IO_HDF5_ARRAY_FILE_MODULE_H

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

// Calls on a file as io/hdf5/array_file.h has them, with their arguments: X(name, types, names).
#define ARRAY_FILE_CALLS(X)                                                                        \
    X(add_vectors, (ArrayFile * file, const ArraySeries *series, int32_t components, Error *err),  \
      (file, series, components, err))                                                             \
    X(append,                                                                                      \
      (ArrayFile * file, const char *name, const double *values, int64_t rows, Error *err),        \
      (file, name, values, rows, err))                                                             \
    X(flush, (ArrayFile * file, Error * err), (file, err))                                         \
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

// io/hdf5/array_file.h describes each call. No `file` is NULL.
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
