// SPDX-License-Identifier: GPL-2.0-or-later
// One-row appends are collected in a buffer a series, which ends where a chunk ends: HDF5 gets
// whole chunks, compresses each once, and is asked rarely.
//
// A killed run leaves a readable file because between two flushes nothing that stands on disk is
// changed: HDF5's metadata cache may not evict (evictions off), freed space is not used again
// (H5F_FSPACE_STRATEGY_NONE), so chunks go to fresh places until the next flush makes them known.
#include "io/array_file.h"

#include "base/memory.h"
#include "io/array_disk.h"
#include "io/part_file.h"

#include <hdf5.h>

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum {
    CHUNK_BYTES = 64 * 1024,   // aimed at; larger ones compress no better and flush slower
    CHUNK_ROWS_MAX = 1024,   // a scalar series is flushed in pieces of 8 kB
    DEFLATE_LEVEL = 2,   // 4 saves 4 % and costs 20 % more time
    FIRST_SERIES = 16,
    CAUSE_SIZE = 512
};

// A series being written. Rows [0, row_count) are with HDF5, `buffered` more wait in `buffer`.
typedef struct Series {
    char *name;   // owned
    ArrayType type;
    int32_t width;
    int64_t chunk_rows;
    int64_t row_count;
    int64_t buffered;
    void *buffer;   // [chunk_rows * width] of the stored type; owned
    hid_t dataset;
} Series;

struct ArrayFile {
    bool writing;
    hid_t id;   // 0: not open
    hid_t driver;   // 0: none; while writing
    ArrayDisk disk;   // while writing
    PartFile part;   // while writing
    char path[PATH_MAX + 8];   // as opened or created, for messages
    int32_t series_count, series_capacity;
    Series *series;   // [series_capacity]; owned
};

// --- what HDF5 has to say -----------------------------------------------------------------------

static herr_t keep_innermost(unsigned position, const H5E_error2_t *entry, void *cause)
{
    if (position == 0) snprintf(cause, CAUSE_SIZE, "%s", entry->desc);
    return 0;
}

// HDF5's own words for the fault nearest to its origin.
static const char *hdf5_cause(char cause[CAUSE_SIZE])
{
    snprintf(cause, CAUSE_SIZE, "HDF5 gives no reason");
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_innermost, cause);
    return cause;
}

// Whether all writes so far reached the disk; what is lost is lost, so this never heals.
static bool check_disk(const ArrayFile *file, Error *err)
{
    if (file->disk.failure != 0)
        FAIL(err, ERROR_FILE, "cannot write %s: %s", file->part.part, strerror(file->disk.failure));
cleanup:
    return error_is_clean(err);
}

// Ends a call that wrote: `status` is HDF5's.
static bool check_written(const ArrayFile *file, herr_t status, const char *name, Error *err)
{
    char cause[CAUSE_SIZE];
    TRY(check_disk(file, err));
    if (status < 0)
        FAIL(err, ERROR_LIBRARY, "cannot write %s into %s: %s", name, file->part.part,
             hdf5_cause(cause));
cleanup:
    return error_is_clean(err);
}

// --- opening and closing ------------------------------------------------------------------------

// How a file is written so that a killed run leaves it readable (see the top).
static herr_t keep_metadata_until_flush(hid_t access)
{
    H5AC_cache_config_t cache = {.version = H5AC__CURR_CACHE_CONFIG_VERSION};
    if (H5Pget_mdc_config(access, &cache) < 0) return -1;
    cache.evictions_enabled = false;
    cache.incr_mode = H5C_incr__off;
    cache.flash_incr_mode = H5C_flash_incr__off;
    cache.decr_mode = H5C_decr__off;
    return H5Pset_mdc_config(access, &cache);
}

static bool create_hdf5(ArrayFile *file, Error *err)
{
    char cause[CAUSE_SIZE];
    hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    hid_t creation = H5Pcreate(H5P_FILE_CREATE);
    if (!array_disk_use(&file->disk, file->part.descriptor, access, &file->driver) ||
        keep_metadata_until_flush(access) < 0 ||
        H5Pset_file_space_strategy(creation, H5F_FSPACE_STRATEGY_NONE, false, 1) < 0)
        FAIL(err, ERROR_LIBRARY, "cannot prepare HDF5 for %s: %s", file->path, hdf5_cause(cause));
    file->id = H5Fcreate(file->part.part, H5F_ACC_TRUNC, creation, access);
    TRY(check_written(file, file->id < 0 ? -1 : 0, "the header", err));
cleanup:
    H5Pclose(access);
    H5Pclose(creation);
    return error_is_clean(err);
}

// Frees everything; a .part still there is left. HDF5 is closed before its driver, and that before
// the descriptor.
static void destroy(ArrayFile *file)
{
    if (!file) return;
    if (file->id > 0) H5Fclose(file->id);
    if (file->driver > 0) H5FDunregister(file->driver);
    part_file_leave(&file->part);
    for (int32_t s = 0; s < file->series_count; s++) {
        memory_free(file->series[s].name);
        memory_free(file->series[s].buffer);
    }
    memory_free(file->series);
    memory_free(file);
}

ArrayFile *array_file_create(const char *path, Error *err)
{
    ArrayFile *file = NEW_ARRAY(ArrayFile, 1, err);
    if (!file) return NULL;
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);   // HDF5 prints its error stack otherwise
    file->writing = true;
    file->series_capacity = FIRST_SERIES;
    file->series = NEW_ARRAY(Series, file->series_capacity, err);
    if (!file->series) goto cleanup;
    TRY(part_file_create(&file->part, path, err));
    snprintf(file->path, sizeof file->path, "%s", path);
    TRY(create_hdf5(file, err));
    return file;
cleanup:
    part_file_discard(&file->part);
    destroy(file);
    return NULL;
}

// `path` or, where only that stands, `path`.part; into file->path.
static bool choose_existing(ArrayFile *file, const char *path, Error *err)
{
    char part[PATH_MAX + 8];
    if (!part_file_name(path, part))
        FAIL(err, ERROR_FILE, "cannot read \"%s\": the name is empty or too long", path);
    snprintf(file->path, sizeof file->path, "%s", path);
    if (access(path, F_OK) == 0) goto cleanup;
    int cause = errno;
    if (access(part, F_OK) != 0)
        FAIL(err, ERROR_FILE, "cannot read %s (nor %s.part): %s", path, path, strerror(cause));
    snprintf(file->path, sizeof file->path, "%s", part);
cleanup:
    return error_is_clean(err);
}

ArrayFile *array_file_open(const char *path, Error *err)
{
    char cause[CAUSE_SIZE];
    hid_t properties = 0;
    ArrayFile *file = NEW_ARRAY(ArrayFile, 1, err);
    if (!file) return NULL;
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    TRY(choose_existing(file, path, err));
    if (access(file->path, R_OK) != 0)
        FAIL(err, ERROR_FILE, "cannot read %s: %s", file->path, strerror(errno));
    properties = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_file_locking(properties, false, true);   // a running simulation's file may be looked at
    file->id = H5Fopen(file->path, H5F_ACC_RDONLY, properties);
    if (file->id < 0)
        FAIL(err, ERROR_FILE, "cannot read %s, not a whole HDF5 file: %s", file->path,
             hdf5_cause(cause));
cleanup:
    if (properties > 0) H5Pclose(properties);
    if (error_is_clean(err)) return file;
    destroy(file);
    return NULL;
}

bool array_file_close(ArrayFile *file, Error *err)
{
    if (!file) return true;
    if (!file->writing) goto cleanup;
    TRY(array_file_flush(file, err));
    herr_t status = H5Fclose(file->id);
    file->id = 0;
    TRY(check_written(file, status, "the end", err));
    TRY(part_file_commit(&file->part, err));
cleanup:
    destroy(file);
    return error_is_clean(err);
}

void array_file_abandon(ArrayFile *file)
{
    Error ignored = {0};
    if (file) array_file_flush(file, &ignored);
    destroy(file);
}

// --- writing series -----------------------------------------------------------------------------

static size_t item_size(ArrayType type)
{
    switch (type) {
    case ARRAY_FLOAT64:
        return sizeof(double);
    case ARRAY_FLOAT32:
        return sizeof(float);
    case ARRAY_UINT8:
        return sizeof(uint8_t);
    case ARRAY_INT32:
        return sizeof(int32_t);
    }
    return 0;
}

static hid_t stored_type(ArrayType type)
{
    switch (type) {
    case ARRAY_FLOAT64:
        return H5T_IEEE_F64LE;
    case ARRAY_FLOAT32:
        return H5T_IEEE_F32LE;
    case ARRAY_UINT8:
        return H5T_STD_U8LE;
    case ARRAY_INT32:
        return H5T_STD_I32LE;
    }
    return -1;
}

static hid_t memory_type(ArrayType type)
{
    switch (type) {
    case ARRAY_FLOAT64:
        return H5T_NATIVE_DOUBLE;
    case ARRAY_FLOAT32:
        return H5T_NATIVE_FLOAT;
    case ARRAY_UINT8:
        return H5T_NATIVE_UINT8;
    case ARRAY_INT32:
        return H5T_NATIVE_INT32;
    }
    return -1;
}

static int64_t rows_of_a_chunk(const ArraySeries *series)
{
    int64_t rows = CHUNK_BYTES / ((int64_t)item_size(series->type) * series->width);
    return rows < 1 ? 1 : rows > CHUNK_ROWS_MAX ? CHUNK_ROWS_MAX : rows;
}

// The text as an attribute of `object`, in UTF-8 of variable length: h5py reads it as str.
static herr_t write_text(hid_t object, const char *name, const char *value)
{
    hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, H5T_VARIABLE);
    H5Tset_cset(type, H5T_CSET_UTF8);
    hid_t space = H5Screate(H5S_SCALAR);
    if (H5Aexists(object, name) > 0) H5Adelete(object, name);
    hid_t attribute = H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    herr_t status = attribute < 0 ? -1 : H5Awrite(attribute, type, &value);
    if (attribute >= 0) H5Aclose(attribute);
    H5Sclose(space);
    H5Tclose(type);
    return status;
}

// An empty, extendable dataset: [0] for scalars, [0, width] otherwise. The id, or negative.
static hid_t create_dataset(hid_t id, const ArraySeries *series, int64_t chunk_rows)
{
    int rank = series->width > 1 ? 2 : 1;
    hsize_t shape[2] = {0, (hsize_t)series->width};
    hsize_t shape_max[2] = {H5S_UNLIMITED, (hsize_t)series->width};
    hsize_t chunk[2] = {(hsize_t)chunk_rows, (hsize_t)series->width};
    size_t chunk_bytes = (size_t)(chunk_rows * series->width) * item_size(series->type);
    hid_t space = H5Screate_simple(rank, shape, shape_max);
    hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    hid_t links = H5Pcreate(H5P_LINK_CREATE);
    hid_t cache = H5Pcreate(H5P_DATASET_ACCESS);
    bool ready = H5Pset_chunk(creation, rank, chunk) >= 0 && H5Pset_shuffle(creation) >= 0 &&
                 H5Pset_deflate(creation, DEFLATE_LEVEL) >= 0 &&
                 H5Pset_create_intermediate_group(links, 1) >= 0 &&
                 H5Pset_chunk_cache(cache, 11, chunk_bytes, 1.0) >= 0;   // one chunk, no more
    hid_t dataset = !ready ? -1
                           : H5Dcreate2(id, series->name, stored_type(series->type), space, links,
                                        creation, cache);
    H5Pclose(cache);
    H5Pclose(links);
    H5Pclose(creation);
    H5Sclose(space);
    return dataset;
}

static bool grow_series_list(ArrayFile *file, Error *err)
{
    if (file->series_count < file->series_capacity) return true;
    Series *longer = memory_resize(file->series, file->series_capacity,
                                   2 * (int64_t)file->series_capacity, sizeof(Series), err);
    if (!longer) return false;
    file->series = longer;
    file->series_capacity *= 2;
    return true;
}

static Series *find_series(const ArrayFile *file, const char *name)
{
    for (int32_t s = 0; s < file->series_count; s++)
        if (strcmp(file->series[s].name, name) == 0) return &file->series[s];
    return NULL;
}

bool array_file_add_series(ArrayFile *file, const ArraySeries *series, Error *err)
{
    Series added = {.type = series->type, .width = series->width, .dataset = -1};
    if (!file->writing) FAIL(err, ERROR_FILE, "%s is open for reading only", file->path);
    if (series->width < 1 || item_size(series->type) == 0)
        FAIL(err, ERROR_FILE, "%s: %s has no values or no type", file->path, series->name);
    if (find_series(file, series->name))
        FAIL(err, ERROR_FILE, "%s holds %s already", file->path, series->name);
    TRY(check_disk(file, err));
    TRY(grow_series_list(file, err));
    added.chunk_rows = rows_of_a_chunk(series);
    added.name = memory_text(series->name, err);
    if (!added.name) goto cleanup;
    added.buffer = memory_array(added.chunk_rows * added.width, item_size(added.type), err);
    if (!added.buffer) goto cleanup;
    added.dataset = create_dataset(file->id, series, added.chunk_rows);
    herr_t status = added.dataset < 0 ? -1 : write_text(added.dataset, "unit", series->unit);
    if (status >= 0) status = write_text(added.dataset, "description", series->description);
    TRY(check_written(file, status, series->name, err));
    file->series[file->series_count++] = added;
    return true;
cleanup:
    if (added.dataset >= 0) H5Dclose(added.dataset);
    memory_free(added.name);
    memory_free(added.buffer);
    return false;
}

// Hands the buffered rows to HDF5.
static bool write_buffer(ArrayFile *file, Series *series, Error *err)
{
    if (series->buffered == 0) return true;
    int rank = series->width > 1 ? 2 : 1;
    hsize_t start[2] = {(hsize_t)series->row_count, 0};
    hsize_t count[2] = {(hsize_t)series->buffered, (hsize_t)series->width};
    hsize_t shape[2] = {start[0] + count[0], count[1]};
    hid_t from = H5Screate_simple(rank, count, NULL);
    hid_t to = -1;
    herr_t status = H5Dset_extent(series->dataset, shape);
    if (status >= 0) to = H5Dget_space(series->dataset);
    if (to >= 0) status = H5Sselect_hyperslab(to, H5S_SELECT_SET, start, NULL, count, NULL);
    if (to >= 0 && status >= 0)
        status = H5Dwrite(series->dataset, memory_type(series->type), from, to, H5P_DEFAULT,
                          series->buffer);
    if (to >= 0) H5Sclose(to);
    H5Sclose(from);
    TRY(check_written(file, status, series->name, err));
    series->row_count += series->buffered;
    series->buffered = 0;
cleanup:
    return error_is_clean(err);
}

static double clamp(double value, double low, double high)
{
    if (isnan(value)) return 0.0;
    return value < low ? low : value > high ? high : rint(value);
}

// buffer[first ...] = values, in the stored type. Integers: nearest, within the type's range.
static void convert(const Series *series, int64_t first, const double *values, int64_t count)
{
    switch (series->type) {
    case ARRAY_FLOAT64:
        memcpy((double *)series->buffer + first, values, (size_t)count * sizeof(double));
        break;
    case ARRAY_FLOAT32:
        for (int64_t k = 0; k < count; k++) ((float *)series->buffer)[first + k] = (float)values[k];
        break;
    case ARRAY_UINT8:
        for (int64_t k = 0; k < count; k++)
            ((uint8_t *)series->buffer)[first + k] = (uint8_t)clamp(values[k], 0, UINT8_MAX);
        break;
    case ARRAY_INT32:
        for (int64_t k = 0; k < count; k++)
            ((int32_t *)series->buffer)[first + k] =
                (int32_t)clamp(values[k], INT32_MIN, INT32_MAX);
        break;
    }
}

bool array_file_append(ArrayFile *file, const char *name, const double *values, int64_t rows,
                       Error *err)
{
    Series *series = find_series(file, name);
    if (!series) FAIL(err, ERROR_FILE, "%s has no series %s to append to", file->path, name);
    TRY(check_disk(file, err));
    while (rows > 0) {
        // The buffer is full where a chunk ends, so that every full buffer is one whole chunk.
        int64_t room = series->chunk_rows - series->row_count % series->chunk_rows -
                       series->buffered;
        int64_t taken = rows < room ? rows : room;
        convert(series, series->buffered * series->width, values, taken * series->width);
        series->buffered += taken;
        values += taken * series->width;
        rows -= taken;
        if (taken == room) TRY(write_buffer(file, series, err));
    }
cleanup:
    return error_is_clean(err);
}

bool array_file_flush(ArrayFile *file, Error *err)
{
    if (!file->writing) return true;
    TRY(check_disk(file, err));
    for (int32_t s = 0; s < file->series_count; s++) TRY(write_buffer(file, &file->series[s], err));
    TRY(check_written(file, H5Fflush(file->id, H5F_SCOPE_LOCAL), "what was appended", err));
cleanup:
    return error_is_clean(err);
}

// --- attributes ---------------------------------------------------------------------------------

bool array_file_set_number(ArrayFile *file, const char *name, double value, Error *err)
{
    TRY(check_disk(file, err));
    if (H5Aexists(file->id, name) > 0) H5Adelete(file->id, name);
    hid_t space = H5Screate(H5S_SCALAR);
    hid_t attribute = H5Acreate2(file->id, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT);
    herr_t status = attribute < 0 ? -1 : H5Awrite(attribute, H5T_NATIVE_DOUBLE, &value);
    if (attribute >= 0) H5Aclose(attribute);
    H5Sclose(space);
    TRY(check_written(file, status, name, err));
cleanup:
    return error_is_clean(err);
}

bool array_file_set_text(ArrayFile *file, const char *name, const char *value, Error *err)
{
    TRY(check_disk(file, err));
    TRY(check_written(file, write_text(file->id, name, value), name, err));
cleanup:
    return error_is_clean(err);
}

bool array_file_get_number(ArrayFile *file, const char *name, double *value, Error *err)
{
    char cause[CAUSE_SIZE];
    hid_t attribute = -1;
    if (H5Aexists(file->id, name) <= 0) FAIL(err, ERROR_FILE, "%s has no %s", file->path, name);
    attribute = H5Aopen(file->id, name, H5P_DEFAULT);
    hid_t space = H5Aget_space(attribute);
    bool is_one = H5Sget_simple_extent_npoints(space) == 1;
    H5Sclose(space);
    if (!is_one || H5Aread(attribute, H5T_NATIVE_DOUBLE, value) < 0)
        FAIL(err, ERROR_FILE, "%s: %s is no number: %s", file->path, name, hdf5_cause(cause));
cleanup:
    if (attribute >= 0) H5Aclose(attribute);
    return error_is_clean(err);
}

bool array_file_get_text(ArrayFile *file, const char *name, char *value, int32_t size, Error *err)
{
    hid_t attribute = -1, type = -1;
    char *stored = NULL;
    if (H5Aexists(file->id, name) <= 0) FAIL(err, ERROR_FILE, "%s has no %s", file->path, name);
    attribute = H5Aopen(file->id, name, H5P_DEFAULT);
    type = H5Aget_type(attribute);
    if (H5Tis_variable_str(type) <= 0 || H5Aread(attribute, type, &stored) < 0 || !stored)
        FAIL(err, ERROR_FILE, "%s: %s is no text", file->path, name);
    snprintf(value, (size_t)size, "%s", stored);
cleanup:
    if (stored) H5free_memory(stored);
    if (type >= 0) H5Tclose(type);
    if (attribute >= 0) H5Aclose(attribute);
    return error_is_clean(err);
}

// --- reading ------------------------------------------------------------------------------------

bool array_file_has(ArrayFile *file, const char *name)
{
    // HDF5 asks link by link: "a/b" exists only where "a" does.
    char prefix[256];
    size_t length = strlen(name);
    if (length == 0 || length >= sizeof prefix) return false;
    for (size_t k = 1; k <= length; k++) {
        if (name[k] != '/' && name[k] != '\0') continue;
        memcpy(prefix, name, k);
        prefix[k] = '\0';
        if (H5Lexists(file->id, prefix, H5P_DEFAULT) <= 0) return false;
    }
    return true;
}

// Rows and width of a dataset of one or two dimensions.
static bool read_shape(const ArrayFile *file, const char *name, hid_t dataset, int64_t *rows,
                       int32_t *width, Error *err)
{
    hsize_t shape[2] = {0, 1};
    hid_t space = H5Dget_space(dataset);
    int rank = H5Sget_simple_extent_ndims(space);
    if (rank < 1 || rank > 2)
        FAIL(err, ERROR_FILE, "%s: %s has %d dimensions, not 1 or 2", file->path, name, rank);
    H5Sget_simple_extent_dims(space, shape, NULL);
    if (shape[0] > INT64_MAX || shape[1] > INT32_MAX ||
        (shape[1] > 0 && shape[0] > INT64_MAX / shape[1]))
        FAIL(err, ERROR_FILE, "%s: %s is too large to be true", file->path, name);
    *rows = (int64_t)shape[0];
    *width = (int32_t)shape[1];
cleanup:
    H5Sclose(space);
    return error_is_clean(err);
}

bool array_file_read(ArrayFile *file, const char *name, double **values, int64_t *rows,
                     int32_t *width, Error *err)
{
    char cause[CAUSE_SIZE];
    hid_t dataset = -1;
    *values = NULL;
    *rows = 0;
    *width = 0;
    TRY(array_file_flush(file, err));
    if (!array_file_has(file, name)) FAIL(err, ERROR_FILE, "%s has no %s", file->path, name);
    dataset = H5Dopen2(file->id, name, H5P_DEFAULT);
    if (dataset < 0)
        FAIL(err, ERROR_FILE, "%s: %s is no array: %s", file->path, name, hdf5_cause(cause));
    TRY(read_shape(file, name, dataset, rows, width, err));
    *values = NEW_ARRAY(double, *rows **width, err);
    if (!*values) goto cleanup;
    if (H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, *values) < 0)
        FAIL(err, ERROR_FILE, "%s: cannot read %s: %s", file->path, name, hdf5_cause(cause));
cleanup:
    if (dataset >= 0) H5Dclose(dataset);
    if (error_is_clean(err)) return true;
    memory_free(*values);
    *values = NULL;
    return false;
}
