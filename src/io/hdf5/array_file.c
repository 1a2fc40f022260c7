// SPDX-License-Identifier: GPL-2.0-or-later
// All is handed on to the module amontons_hdf5.so, which is opened with the first file: HDF5 takes
// 6 ms to load, as much as a short run's steps. The functions of the module come in one table
// (array_file_module.h), so that one symbol is looked up and the compiler checks their signatures.
#include "io/hdf5/array_file.h"

#include "base/memory.h"
#include "base/module.h"
#include "io/hdf5/array_file_module.h"

struct ArrayFile {
    const ArrayFileModule *module;   // whose file it is
    Hdf5File *hdf5;   // owned
};

typedef enum Way { CREATE, OPEN, REOPEN } Way;

static ArrayFile *begin(const char *path, Way way, Error *err)
{
    ArrayFileModuleFunction module =
        (ArrayFileModuleFunction)module_function("hdf5", "amontons_array_file_module", err);
    ArrayFile *file = module ? NEW_ARRAY(ArrayFile, 1, err) : NULL;
    if (!file) return NULL;
    const ArrayFileModule *calls = file->module = module();
    file->hdf5 = (way == CREATE ? calls->create
                  : way == OPEN ? calls->open
                                : calls->reopen)(path, err);
    if (file->hdf5) return file;
    memory_free(file);
    return NULL;
}

ArrayFile *array_file_create(const char *path, Error *err)
{
    return begin(path, CREATE, err);
}

ArrayFile *array_file_open(const char *path, Error *err)
{
    return begin(path, OPEN, err);
}

ArrayFile *array_file_reopen(const char *path, Error *err)
{
    return begin(path, REOPEN, err);
}

bool array_file_close(ArrayFile *file, Error *err)
{
    if (!file) return true;
    bool closed = file->module->close(file->hdf5, err);
    memory_free(file);
    return closed;
}

void array_file_abandon(ArrayFile *file)
{
    if (!file) return;
    file->module->abandon(file->hdf5);
    memory_free(file);
}

bool array_file_add_series(ArrayFile *file, const ArraySeries *series, Error *err)
{
    return file->module->add_vectors(file->hdf5, series, 1, err);
}

bool array_file_add_vectors(ArrayFile *file, const ArraySeries *series, int32_t components,
                            Error *err)
{
    return file->module->add_vectors(file->hdf5, series, components, err);
}

bool array_file_append(ArrayFile *file, const char *name, const double *values, int64_t rows,
                       Error *err)
{
    return file->module->append(file->hdf5, name, values, rows, err);
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

bool array_file_flush(ArrayFile *file, Error *err)
{
    return file->module->flush(file->hdf5, err);
}

bool array_file_sync(ArrayFile *file, Error *err)
{
    return file->module->sync(file->hdf5, err);
}

bool array_file_cut(ArrayFile *file, const char *name, int64_t rows, Error *err)
{
    return file->module->cut(file->hdf5, name, rows, err);
}

bool array_file_remove(ArrayFile *file, const char *name, Error *err)
{
    return file->module->remove(file->hdf5, name, err);
}

bool array_file_set_number(ArrayFile *file, const char *name, double value, Error *err)
{
    return file->module->set_number(file->hdf5, name, value, err);
}

bool array_file_set_text(ArrayFile *file, const char *name, const char *value, Error *err)
{
    return file->module->set_text(file->hdf5, name, value, err);
}

bool array_file_get_number(ArrayFile *file, const char *name, double *value, Error *err)
{
    return file->module->get_number(file->hdf5, name, value, err);
}

bool array_file_get_text(ArrayFile *file, const char *name, char *value, int32_t size, Error *err)
{
    return file->module->get_text(file->hdf5, name, value, size, err);
}

bool array_file_read(ArrayFile *file, const char *name, double **values, int64_t *rows,
                     int32_t *width, Error *err)
{
    return file->module->read(file->hdf5, name, values, rows, width, err);
}

bool array_file_has(ArrayFile *file, const char *name)
{
    return file->module->has(file->hdf5, name);
}
