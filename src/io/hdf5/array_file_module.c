// SPDX-License-Identifier: GPL-2.0-or-later
// A killed run leaves a readable file, because between two flushes nothing changes that a reader
// looks at:
//   * the tables that say where the chunks are stay in HDF5's cache (evictions are off);
//   * a chunk that is written again, as the last one of a series is, goes to a fresh place, for
//     space is handed out once (array_disk) and not managed (H5F_FSPACE_STRATEGY_NONE);
//   * what H5Fflush writes over, the tables, comes into the file through a journal, all or nothing.
// HDF5's own way, SWMR, allows no new arrays or attributes while writing, and marks a killed
// writer's file so that ordinary readers refuse it.
#include "io/hdf5/array_file_module.h"

#include "base/memory.h"
#include "io/files/part_file.h"
#include "io/hdf5/array_attribute.h"
#include "io/hdf5/array_disk.h"
#include "io/hdf5/array_series.h"

#include <hdf5.h>

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { FIRST_SERIES = 16 };   // room for series before the list grows

struct ArrayFile {
    const ArrayFileModule *module;   // stands first
    char path[PATH_MAX + 8];   // what is read, or what a written file will be called
    hid_t id;   // 0: not open
    bool writing;   // created here: what follows is in use
    PartFile part;
    ArrayDisk disk;   // under HDF5, over `part`
    hid_t driver;   // that makes HDF5 use `disk`; 0: none
    int32_t series_count, series_capacity;
    SeriesWriter *series;   // [series_capacity]; owned
};

// Whether the file can be written, and all written so far has reached the disk.
static bool check_writable(const ArrayFile *file, Error *err)
{
    if (!file->writing) return FAULT(err, ERROR_LIBRARY, "%s is open for reading only", file->path);
    return array_disk_check(&file->disk, 0, "", err);
}

// First our own buffers, then HDF5's.
static bool write_all(ArrayFile *file, Error *err)
{
    if (!check_writable(file, err)) return false;
    for (int32_t s = 0; s < file->series_count; s++)
        if (!series_hand_over(&file->series[s], &file->disk, err)) return false;
    herr_t status = H5Fflush(file->id, H5F_SCOPE_LOCAL);
    return array_disk_check(&file->disk, status, "what was appended", err);
}

static bool hdf5_flush(ArrayFile *file, Error *err)
{
    return !file->writing || (write_all(file, err) && array_disk_settle(&file->disk, err));
}

static bool hdf5_sync(ArrayFile *file, Error *err)
{
    return hdf5_flush(file, err) && array_disk_sync(&file->disk, err);
}

// --- opening and closing ------------------------------------------------------------------------

// The metadata cache may write only when told to. It then grows with the file, by some kilobytes a
// thousand chunks.
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

// The HDF5 file over the part that is open already: an empty one, or what is in it.
static bool begin_hdf5(ArrayFile *file, bool anew, Error *err)
{
    char cause[HDF5_CAUSE_SIZE];
    hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    hid_t creation = H5Pcreate(H5P_FILE_CREATE);
    TRY(array_disk_open(&file->disk, &file->part, anew, err));
    if (!array_disk_use(&file->disk, access, &file->driver) ||
        keep_metadata_until_flush(access) < 0 ||
        H5Pset_file_space_strategy(creation, H5F_FSPACE_STRATEGY_NONE, false, 1) < 0)
        FAIL(err, ERROR_LIBRARY, "cannot prepare HDF5 for %s: %s", file->path, hdf5_cause(cause));
    file->id = anew ? H5Fcreate(file->part.part, H5F_ACC_TRUNC, creation, access)
                    : H5Fopen(file->part.part, H5F_ACC_RDWR, access);
    if (file->id < 0 && !anew)
        FAIL(err, ERROR_FILE, "cannot go on with %s, not a whole HDF5 file: %s", file->part.part,
             hdf5_cause(cause));
    TRY(array_disk_check(&file->disk, file->id < 0 ? -1 : 0, "the header", err));
cleanup:
    H5Pclose(access);
    H5Pclose(creation);
    return error_is_clean(err);
}

// A .part still there is left. HDF5 is closed before its driver, and that before the descriptor.
static void destroy(ArrayFile *file)
{
    if (!file) return;
    for (int32_t s = 0; s < file->series_count; s++) series_destroy(&file->series[s]);
    if (file->id > 0) H5Fclose(file->id);
    if (file->driver > 0) H5FDunregister(file->driver);
    array_disk_close(&file->disk);
    part_file_leave(&file->part);
    memory_free_all(file->series, file);
}

static ArrayFile *new_file(Error *err)
{
    ArrayFile *file = NEW_ARRAY(ArrayFile, 1, err);
    if (!file) return NULL;
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);   // HDF5 prints its error stack otherwise
    file->module = amontons_array_file_module();
    return file;
}

// For writing. A second writer of the path is refused by part_file as long as this one is open.
static ArrayFile *begin_writing(const char *path, bool anew, Error *err)
{
    ArrayFile *file = new_file(err);
    if (!file) return NULL;
    file->writing = true;
    file->series_capacity = FIRST_SERIES;
    TRY((file->series = NEW_ARRAY(SeriesWriter, file->series_capacity, err)));
    TRY(anew ? part_file_create(&file->part, path, err) : part_file_reopen(&file->part, path, err));
    snprintf(file->path, sizeof file->path, "%s", path);
    TRY(begin_hdf5(file, anew, err));
    return file;
cleanup:
    if (anew) part_file_discard(&file->part);
    destroy(file);
    return NULL;
}

static ArrayFile *hdf5_create(const char *path, Error *err)
{
    return begin_writing(path, true, err);
}

static ArrayFile *hdf5_reopen(const char *path, Error *err)
{
    return begin_writing(path, false, err);
}

// `path` or, where only that stands, `path`.part; into file->path.
static bool choose_existing(ArrayFile *file, const char *path, Error *err)
{
    char part[PATH_MAX + 8];
    if (!part_file_name(path, part))
        return FAULT(err, ERROR_FILE, "the name of the file to read is empty or too long: \"%s\"",
                     path);
    snprintf(file->path, sizeof file->path, "%s", path);
    if (access(path, F_OK) == 0) return true;
    int cause = errno;
    if (access(part, F_OK) != 0)
        return FAULT(err, ERROR_FILE, "cannot read %s (nor %s.part): %s", path, path,
                     strerror(cause));
    snprintf(file->path, sizeof file->path, "%s", part);
    return error_is_clean(err);
}

// By our driver; a file that has not got its name yet through the journal that its writer left.
static bool use_disk(ArrayFile *file, const char *path, hid_t access, Error *err)
{
    char cause[HDF5_CAUSE_SIZE];
    bool finished = strcmp(file->path, path) == 0;
    if (!part_file_look(&file->part, path, finished, err)) return false;
    if (!array_disk_look(&file->disk, &file->part, finished, err)) return false;
    if (!array_disk_use(&file->disk, access, &file->driver))
        return FAULT(err, ERROR_LIBRARY, "cannot read %s: %s", file->path, hdf5_cause(cause));
    return true;
}

// Without a lock, so that the file of a running simulation can be read as of its last flush.
static ArrayFile *hdf5_open(const char *path, Error *err)
{
    char cause[HDF5_CAUSE_SIZE];
    hid_t properties = 0;
    ArrayFile *file = new_file(err);
    if (!file) return NULL;
    TRY(choose_existing(file, path, err));
    if (access(file->path, R_OK) != 0)
        FAIL(err, ERROR_FILE, "cannot read %s: %s", file->path, strerror(errno));
    properties = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_file_locking(properties, false, true);
    TRY(use_disk(file, path, properties, err));
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

// HDF5 writes once more when it closes.
static bool end_writing(ArrayFile *file, Error *err)
{
    if (!write_all(file, err)) return false;
    for (int32_t s = 0; s < file->series_count; s++) series_destroy(&file->series[s]);
    herr_t status = H5Fclose(file->id);
    file->id = 0;
    return array_disk_check(&file->disk, status, "the end", err) &&
           array_disk_end(&file->disk, err);
}

// Where one of these fails the name is not given.
static bool hdf5_close(ArrayFile *file, Error *err)
{
    if (!file->writing) goto cleanup;
    TRY(end_writing(file, err));
    TRY(part_file_commit(&file->part, err));
cleanup:
    destroy(file);
    return error_is_clean(err);
}

// After a failure or a stop: what there is stays readable as `path`.part.
static void hdf5_abandon(ArrayFile *file)
{
    Error ignored = {0};
    end_writing(file, &ignored);
    destroy(file);
}

// --- attributes ---------------------------------------------------------------------------------

// They stand in the root of the file.
static bool hdf5_set_number(ArrayFile *file, const char *name, double value, Error *err)
{
    if (!check_writable(file, err)) return false;
    herr_t status = attribute_write_number(file->id, name, value);
    return array_disk_check(&file->disk, status, name, err);
}

static bool hdf5_set_text(ArrayFile *file, const char *name, const char *value, Error *err)
{
    if (!check_writable(file, err)) return false;
    herr_t status = attribute_write_text(file->id, name, value);
    return array_disk_check(&file->disk, status, name, err);
}

static bool hdf5_get_number(ArrayFile *file, const char *name, double *value, Error *err)
{
    char cause[HDF5_CAUSE_SIZE];
    if (H5Aexists(file->id, name) <= 0)
        return FAULT(err, ERROR_FILE, "%s has no %s", file->path, name);
    if (attribute_read_number(file->id, name, value) < 0)
        return FAULT(err, ERROR_FILE, "%s: %s is no number: %s", file->path, name,
                     hdf5_cause(cause));
    return true;
}

static bool hdf5_get_text(ArrayFile *file, const char *name, char *value, int32_t size, Error *err)
{
    if (H5Aexists(file->id, name) <= 0)
        return FAULT(err, ERROR_FILE, "%s has no %s", file->path, name);
    if (attribute_read_text(file->id, name, value, size) < 0)
        return FAULT(err, ERROR_FILE, "%s: %s is no text", file->path, name);
    return true;
}

// --- writing series -----------------------------------------------------------------------------

static bool hdf5_has(ArrayFile *file, const char *name)
{
    return H5Lexists(file->id, name, H5P_DEFAULT) > 0;   // negative where a folder is missing
}

// NULL: none. A file has some twenty series, so a scan will do.
static SeriesWriter *find_series(const ArrayFile *file, const char *name)
{
    for (int32_t s = 0; s < file->series_count; s++)
        if (strcmp(file->series[s].name, name) == 0) return &file->series[s];
    return NULL;
}

static bool grow_series_list(ArrayFile *file, Error *err)
{
    return memory_grow(&file->series, file->series_count, &file->series_capacity,
                       sizeof(SeriesWriter), err);
}

// Unit and description are attributes of the dataset: a reader finds them beside the numbers.
static bool hdf5_add_vectors(ArrayFile *file, const ArraySeries *series, int32_t components,
                             Error *err)
{
    SeriesWriter added = {0};
    TRY(check_writable(file, err));
    if (find_series(file, series->name))
        FAIL(err, ERROR_LIBRARY, "%s holds %s already", file->path, series->name);
    TRY(grow_series_list(file, err));
    TRY(series_create(&added, file->id, series, components, err));
    herr_t status = attribute_write_text(added.dataset, "unit", series->unit);
    if (status >= 0)
        status = attribute_write_text(added.dataset, "description", series->description);
    TRY(array_disk_check(&file->disk, status, series->name, err));
    file->series[file->series_count++] = added;
    added = (SeriesWriter){0};   // the list owns it now
cleanup:
    series_destroy(&added);
    return error_is_clean(err);
}

static bool hdf5_append(ArrayFile *file, const char *name, const double *values, int64_t rows,
                        Error *err)
{
    SeriesWriter *series = find_series(file, name);
    if (!check_writable(file, err)) return false;
    if (!series)
        return FAULT(err, ERROR_LIBRARY, "%s has no series %s to append to", file->path, name);
    return series_append(series, &file->disk, values, rows, err);
}

// A series of a reopened file is opened when it is first cut.
static bool hdf5_cut(ArrayFile *file, const char *name, int64_t rows, Error *err)
{
    SeriesWriter opened = {0}, *series = find_series(file, name);
    TRY(check_writable(file, err));
    if (!series) {
        TRY(grow_series_list(file, err));
        TRY(series_open(&opened, file->id, name, err));
        series = &file->series[file->series_count++];
        *series = opened;
        opened = (SeriesWriter){0};   // the list owns it now
    }
    TRY(series_cut(series, &file->disk, rows, err));
cleanup:
    series_destroy(&opened);
    return error_is_clean(err);
}

// Of a series that is being written nothing may be removed; tables and attributes are.
static bool hdf5_remove(ArrayFile *file, const char *name, Error *err)
{
    herr_t status = 0;
    if (!check_writable(file, err)) return false;
    if (H5Aexists(file->id, name) > 0) status = H5Adelete(file->id, name);
    if (hdf5_has(file, name)) status = H5Ldelete(file->id, name, H5P_DEFAULT);
    return array_disk_check(&file->disk, status, name, err);
}

// --- reading ------------------------------------------------------------------------------------

// *values: [*rows * *width], the caller's; memory_free.
static bool hdf5_read(ArrayFile *file, const char *name, double **values, int64_t *rows,
                      int32_t *width, Error *err)
{
    char cause[HDF5_CAUSE_SIZE];
    hid_t dataset = -1;
    int32_t components = 1;
    *values = NULL;
    *rows = 0;
    *width = 0;
    TRY(hdf5_flush(file, err));   // a file being written can be read, too
    if (!hdf5_has(file, name)) FAIL(err, ERROR_FILE, "%s has no %s", file->path, name);
    dataset = H5Dopen2(file->id, name, H5P_DEFAULT);
    if (dataset < 0)
        FAIL(err, ERROR_FILE, "%s: %s is no array: %s", file->path, name, hdf5_cause(cause));
    if (!series_shape(dataset, rows, width, &components))
        FAIL(err, ERROR_FILE, "%s: %s has a shape that cannot be true", file->path, name);
    TRY((*values = memory_bytes(*rows * *width * (int64_t)sizeof(double), err)));
    if (H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, *values) < 0)
        FAIL(err, ERROR_FILE, "%s: cannot read %s: %s", file->path, name, hdf5_cause(cause));
cleanup:
    if (dataset >= 0) H5Dclose(dataset);
    if (error_is_clean(err)) return true;
    memory_free(*values);   // half read
    *values = NULL;
    return false;
}

// --- the module's one entry ---------------------------------------------------------------------

// One table of functions, so that a single look-up by name binds all of them.
__attribute__((visibility("default"))) const ArrayFileModule *amontons_array_file_module(void)
{
    static const ArrayFileModule module = {.create = hdf5_create,
                                           .open = hdf5_open,
                                           .reopen = hdf5_reopen,
                                           .close = hdf5_close,
                                           .abandon = hdf5_abandon,
#define X(name, types, names) .name = hdf5_##name,
                                           ARRAY_FILE_CALLS(X)
#undef X
    };
    return &module;
}
