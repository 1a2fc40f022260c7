// SPDX-License-Identifier: GPL-2.0-or-later
// All is handed on to the module amontons_hdf5.so, which is opened with the first file: HDF5 takes
// 6 ms to load, as much as a short run's steps. The functions of the module come in one table, so
// that one symbol is looked up and the compiler checks their signatures.
#include "io/hdf5/array_file.h"

#include "base/module.h"

#include <stddef.h>

static const ArrayFileModule *find_module(Error *err)
{
    ArrayFileModuleFunction module =
        (ArrayFileModuleFunction)module_function("hdf5", "amontons_array_file_module", err);
    return module ? module() : NULL;
}

static const ArrayFileModule *module_of(const ArrayFile *file)
{
    return *(const ArrayFileModule *const *)(const void *)file;
}

ArrayFile *array_file_create(const char *path, Error *err)
{
    const ArrayFileModule *module = find_module(err);
    return module ? module->create(path, err) : NULL;
}

ArrayFile *array_file_open(const char *path, Error *err)
{
    const ArrayFileModule *module = find_module(err);
    return module ? module->open(path, err) : NULL;
}

ArrayFile *array_file_reopen(const char *path, Error *err)
{
    const ArrayFileModule *module = find_module(err);
    return module ? module->reopen(path, err) : NULL;
}

bool array_file_close(ArrayFile *file, Error *err)
{
    return !file || module_of(file)->close(file, err);
}

void array_file_abandon(ArrayFile *file)
{
    if (file) module_of(file)->abandon(file);
}

#define X(name, types, names)                                                                      \
    bool array_file_##name types                                                                   \
    {                                                                                              \
        return module_of(file)->name names;                                                        \
    }
ARRAY_FILE_CALLS(X)
#undef X

bool array_file_add_series(ArrayFile *file, const ArraySeries *series, Error *err)
{
    return array_file_add_vectors(file, series, 1, err);
}

bool array_file_write(ArrayFile *file, const ArraySeries *series, const double *values,
                      int32_t stride, int64_t rows, Error *err)
{
    if (!array_file_add_series(file, series, err)) return false;
    if (stride == 0) return array_file_append(file, series->name, values, rows, err);
    for (int64_t k = 0; k < rows; k++)
        if (!array_file_append(file, series->name, values + k * stride, 1, err)) return false;
    return error_is_clean(err);
}
