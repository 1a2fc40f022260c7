// SPDX-License-Identifier: GPL-2.0-or-later
// What the module amontons_hdf5.so offers: io/hdf5/array_file.h, call by call, with HDF5 behind it.
// A module, because Debian's HDF5 loads 40 libraries (curl, ssl, kerberos ...), which takes longer
// than all else that a short run does outside its time loop.
#ifndef AMONTONS_IO_HDF5_ARRAY_FILE_MODULE_H
#define AMONTONS_IO_HDF5_ARRAY_FILE_MODULE_H

#include "base/error.h"
#include "io/hdf5/array_types.h"

typedef struct Hdf5File Hdf5File;   // the module's own; an ArrayFile owns one

// What each does stands in io/hdf5/array_file.h. No `file` is NULL.
typedef struct ArrayFileModule {
    Hdf5File *(*create)(const char *path, Error *err);
    Hdf5File *(*open)(const char *path, Error *err);
    Hdf5File *(*reopen)(const char *path, Error *err);
    bool (*close)(Hdf5File *file, Error *err);   // frees `file` either way
    void (*abandon)(Hdf5File *file);
    bool (*add_vectors)(Hdf5File *file, const ArraySeries *series, int32_t components, Error *err);
    bool (*append)(Hdf5File *file, const char *name, const double *values, int64_t rows,
                   Error *err);
    bool (*flush)(Hdf5File *file, Error *err);
    bool (*sync)(Hdf5File *file, Error *err);
    bool (*cut)(Hdf5File *file, const char *name, int64_t rows, Error *err);
    bool (*remove)(Hdf5File *file, const char *name, Error *err);
    bool (*set_number)(Hdf5File *file, const char *name, double value, Error *err);
    bool (*set_text)(Hdf5File *file, const char *name, const char *value, Error *err);
    bool (*get_number)(Hdf5File *file, const char *name, double *value, Error *err);
    bool (*get_text)(Hdf5File *file, const char *name, char *value, int32_t size, Error *err);
    bool (*read)(Hdf5File *file, const char *name, double **values, int64_t *rows, int32_t *width,
                 Error *err);
    bool (*has)(Hdf5File *file, const char *name);
} ArrayFileModule;

// The module's one entry, "amontons_array_file_module": a table that lasts as long as the program.
typedef const ArrayFileModule *(*ArrayFileModuleFunction)(void);
const ArrayFileModule *amontons_array_file_module(void);

#endif
