// SPDX-License-Identifier: GPL-2.0-or-later
// A file that is being written is one in memory. array_file_flush puts its bytes on the disk beside
// the file that is there, and replaces that by renaming: a kill, a full disk or a power cut leaves
// the one or the other, each whole, which any program can read. HDF5's own way, SWMR, allows no new
// arrays or attributes while writing, takes twice the time, marks a killed writer's file so that
// ordinary readers refuse it, and has HDF5 write to a disk that may be full, on which it crashes.
#include "io/hdf5/array_file.h"

#include "base/memory.h"
#include "base/system.h"
#include "base/transfer.h"
#include "io/files/file_lock.h"
#include "io/files/part_file.h"
#include "io/hdf5/array_series.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

enum { FIRST_SERIES = 16 };   // room for series before the list grows

struct ArrayFile {
    const ArrayFileModule *module;   // stands first
    char path[PATH_MAX + 8];   // what is read, or what a written file will be called
    hid_t id;   // of the file in memory, or of the one that is read; 0: not open
    bool writing;   // created here: what follows is in use
    bool changed;   // since the last flush
    int64_t flushed;   // bytes of the last flush
    bool broken;   // HDF5 failed to write: it is not to be closed
    PartFile part;
    int32_t series_count, series_capacity;
    SeriesWriter *series;   // [series_capacity]; owned
};

// Is asked before a call that changes the file.
static bool may_change(ArrayFile *file, Error *err)
{
    if (!file->writing) return FAULT(err, ERROR_LIBRARY, "%s is open for reading only", file->path);
    if (file->broken) return FAULT(err, ERROR_LIBRARY, "%s could not be written", file->part.part);
    file->changed = true;
    return true;
}

// The end of a call of HDF5's that writes `what`.
static bool wrote(ArrayFile *file, herr_t status, const char *what, Error *err)
{
    file->broken |= status < 0;
    return hdf5_wrote(status, file->part.part, what, err);
}

// --- onto the disk ------------------------------------------------------------------------------

static bool hand_over_all(ArrayFile *file, Error *err)
{
    for (int32_t s = 0; s < file->series_count; s++)
        if (!series_hand_over(&file->series[s], file->part.part, err)) {
            file->broken = true;
            return false;
        }
    return true;
}

static bool hdf5_flush(ArrayFile *file, Error *err)
{
    const char *part = file->part.part;
    struct stat status;
    PartFile next = {0};
    int64_t size = 0;
    if (!file->writing) return true;

    // Somebody may have removed or cut what was written.
    if (!file_is_named(part, file->part.descriptor) || fstat(file->part.descriptor, &status) != 0 ||
        status.st_size != file->flushed)
        file->changed = true;
    if (!file->changed) return true;
    if (!may_change(file, err) || !hand_over_all(file, err)) return false;
    const void *bytes = hdf5_memory_bytes(file->id, part, &size, err);
    file->broken = !bytes;
    TRY(bytes);
    TRY(part_file_begin_next(&file->part, &next, err));
    TRY(part_file_write(&next, bytes, size, err));
    TRY(part_file_take_next(&file->part, &next, err));
    file->changed = false;
    file->flushed = size;
cleanup:
    part_file_discard(&next);
    return error_is_clean(err);
}

// --- opening and closing ------------------------------------------------------------------------

// A .part still there is left. What HDF5 could not write is left open (io/hdf5/hdf5_library).
static void destroy(ArrayFile *file)
{
    if (!file) return;
    if (file->broken)
        for (int32_t s = 0; s < file->series_count; s++) file->series[s].dataset = 0;
    for (int32_t s = 0; s < file->series_count; s++) series_destroy(&file->series[s]);
    if (file->id > 0 && !file->broken) H5Fclose(file->id);
    part_file_leave(&file->part);
    memory_free_all(file->series, file);
}

static ArrayFile *new_file(Error *err)
{
    ArrayFile *file = NEW_ARRAY(ArrayFile, 1, err);
    if (file) file->module = amontons_array_file_module();
    return file;
}

// A second writer of the path is refused by part_file as long as this one is open.
static ArrayFile *hdf5_create(const char *path, Error *err)
{
    ArrayFile *file = new_file(err);
    if (!file) return NULL;
    file->writing = file->changed = true;
    file->series_capacity = FIRST_SERIES;
    TRY((file->series = NEW_ARRAY(SeriesWriter, file->series_capacity, err)));
    TRY(part_file_create(&file->part, path, err));
    snprintf(file->path, sizeof file->path, "%s", path);
    TRY((file->id = hdf5_memory_create(file->part.part, err)) > 0);
    return file;
cleanup:
    part_file_discard(&file->part);
    destroy(file);
    return NULL;
}

// Earlier versions kept a long history that was being written in several files.
static bool refuse_parts(const ArrayFile *file, const char *path, Error *err)
{
    if (H5Aexists(file->id, "parts") <= 0) return true;
    return REFUSE(
        err,
        "%s has only the last rows, those before are in %s.1, ...: the run was killed, and "
        "an earlier version of amontons wrote it, which alone can continue it (--resume) "
        "and join them",
        path, path);
}

// Nothing is written before the first flush; a finished file is called .part again.
static ArrayFile *hdf5_reopen(const char *path, Error *err)
{
    char *bytes = NULL;
    struct stat status;
    ArrayFile *file = new_file(err);
    if (!file) return NULL;
    file->writing = true;
    file->series_capacity = FIRST_SERIES;
    TRY((file->series = NEW_ARRAY(SeriesWriter, file->series_capacity, err)));
    TRY(part_file_reopen(&file->part, path, err));
    const char *part = file->part.part;
    snprintf(file->path, sizeof file->path, "%s", path);
    if (fstat(file->part.descriptor, &status) != 0)
        FAIL(err, ERROR_FILE, "cannot read %s: %s", part, strerror(errno));
    file->flushed = status.st_size;
    // HDF5 takes a copy, and whoever wrote it had it in memory beside the run itself.
    if ((double)file->flushed > system_memory() / 2)
        FAIL(err, ERROR_INPUT, "%s has %.3g GB, and this computer %.3g GB of memory for two copies",
             part, (double)file->flushed / 1e9, system_memory() / 1e9);
    TRY(bytes = memory_bytes(file->flushed, err));
    if (transfer_read(file->part.descriptor, bytes, file->flushed, 0) != file->flushed) {
        error_set(err, ERROR_FILE, __FILE__, __LINE__, "cannot read %s: %s", part,
                  strerror(errno ? errno : EIO));
        memory_free(bytes);
        goto cleanup;
    }
    TRY((file->id = hdf5_memory_open(part, bytes, file->flushed, err)) > 0);
    TRY(refuse_parts(file, part, err));
    return file;
cleanup:
    destroy(file);
    return NULL;
}

// Opens `path` or, where only that stands, `path`.part.
static ArrayFile *hdf5_open(const char *path, Error *err)
{
    char part[PATH_MAX + 8];
    ArrayFile *file = new_file(err);
    if (!file) return NULL;
    if (!part_file_name(path, part))
        FAIL(err, ERROR_FILE, "the name of the file to read is empty or too long: \"%s\"", path);
    bool whole = access(path, F_OK) == 0;
    int cause = errno;
    if (!whole && access(part, F_OK) != 0)
        FAIL(err, ERROR_FILE, "cannot read %s (nor %s): %s", path, part, strerror(cause));
    snprintf(file->path, sizeof file->path, "%s", whole ? path : part);
    TRY((file->id = hdf5_disk_open(file->path, err)) > 0);
    TRY(refuse_parts(file, file->path, err));
    return file;
cleanup:
    destroy(file);
    return NULL;
}

// Where closing fails, the file keeps the name `path`.part.
static bool hdf5_close(ArrayFile *file, Error *err)
{
    if (file->writing && hdf5_flush(file, err)) part_file_commit(&file->part, err);
    destroy(file);
    return error_is_clean(err);
}

// After a failure or a stop: what there is stays readable as `path`.part.
static void hdf5_abandon(ArrayFile *file)
{
    Error ignored = {0};
    hdf5_flush(file, &ignored);
    destroy(file);
}

// --- attributes ---------------------------------------------------------------------------------

// They stand in the root of the file.
static bool hdf5_set_number(ArrayFile *file, const char *name, double value, Error *err)
{
    return may_change(file, err) &&
           wrote(file, attribute_write_number(file->id, name, value), name, err);
}

static bool hdf5_set_text(ArrayFile *file, const char *name, const char *value, Error *err)
{
    return may_change(file, err) &&
           wrote(file, attribute_write_text(file->id, name, value), name, err);
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

// Unit and description are attributes of the dataset: a reader finds them beside the numbers.
static bool hdf5_add_vectors(ArrayFile *file, const ArraySeries *series, int32_t components,
                             Error *err)
{
    SeriesWriter added = {0};
    TRY(may_change(file, err));
    if (find_series(file, series->name))
        FAIL(err, ERROR_LIBRARY, "%s holds %s already", file->path, series->name);
    TRY(memory_grow(&file->series, file->series_count, &file->series_capacity, sizeof *file->series,
                    err));
    TRY(series_create(&added, file->id, series, components, err));
    herr_t status = attribute_write_text(added.dataset, "unit", series->unit);
    if (status >= 0)
        status = attribute_write_text(added.dataset, "description", series->description);
    TRY(wrote(file, status, series->name, err));
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
    if (!may_change(file, err)) return false;
    if (!series)
        return FAULT(err, ERROR_LIBRARY, "%s has no series %s to append to", file->path, name);
    if (series_append(series, file->part.part, values, rows, err)) return true;
    file->broken = true;
    return false;
}

static bool hdf5_take_up(ArrayFile *file, const ArraySeries *series, int32_t components, Error *err)
{
    SeriesWriter opened = {0};
    TRY(may_change(file, err));
    if (find_series(file, series->name))
        FAIL(err, ERROR_LIBRARY, "%s has taken up %s already", file->path, series->name);
    TRY(memory_grow(&file->series, file->series_count, &file->series_capacity, sizeof *file->series,
                    err));
    if (!series_open(&opened, file->id, series, components, err)) {
        error_context(err, "%s", file->part.part);
        goto cleanup;
    }
    file->series[file->series_count++] = opened;
    opened = (SeriesWriter){0};   // the list owns it now
cleanup:
    series_destroy(&opened);
    return error_is_clean(err);
}

static bool hdf5_cut(ArrayFile *file, const char *name, int64_t rows, Error *err)
{
    SeriesWriter *series = find_series(file, name);
    if (!may_change(file, err)) return false;
    if (!series) return FAULT(err, ERROR_FILE, "%s has no series %s to cut", file->path, name);
    return series_cut(series, file->part.part, rows, err);
}

// Removes a table or an attribute. A series that is being written must not be removed.
static bool hdf5_remove(ArrayFile *file, const char *name, Error *err)
{
    herr_t status = 0;
    if (!may_change(file, err)) return false;
    if (H5Aexists(file->id, name) > 0) status = H5Adelete(file->id, name);
    if (hdf5_has(file, name)) status = H5Ldelete(file->id, name, H5P_DEFAULT);
    return wrote(file, status, name, err);
}

// --- reading ------------------------------------------------------------------------------------

// A file being written can be read, too.
static bool hdf5_read(ArrayFile *file, const char *name, double **values, int64_t *rows,
                      int32_t *width, Error *err)
{
    char cause[HDF5_CAUSE_SIZE], why[SHAPE_WHY_SIZE];
    hid_t dataset = -1;
    int64_t row_count = 0;
    int32_t columns = 0, components = 0;
    double *read = NULL;
    TRY(hand_over_all(file, err));
    if (H5Lexists(file->id, name, H5P_DEFAULT) <= 0)
        FAIL(err, ERROR_FILE, "%s has no %s", file->path, name);
    dataset = H5Dopen2(file->id, name, H5P_DEFAULT);
    if (dataset < 0)
        FAIL(err, ERROR_FILE, "%s: %s is no array: %s", file->path, name, hdf5_cause(cause));
    if (!series_shape(dataset, &row_count, &columns, &components, why))
        FAIL(err, ERROR_FILE, "%s: %s %s", file->path, name, why);
    TRY(read = memory_bytes(row_count * columns * (int64_t)sizeof(double), err));
    if (H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, read) < 0)
        FAIL(err, ERROR_FILE, "%s: cannot read %s: %s", file->path, name, hdf5_cause(cause));
cleanup:
    if (dataset >= 0) H5Dclose(dataset);
    bool done = error_is_clean(err);
    if (!done) memory_free(read);
    *values = done ? read : NULL;
    *rows = done ? row_count : 0;
    *width = done ? columns : 0;
    return done;
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
