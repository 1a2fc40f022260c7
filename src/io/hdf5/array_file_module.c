// SPDX-License-Identifier: GPL-2.0-or-later
// A file that is being written is one in memory. array_file_flush puts its bytes on the disk beside
// the file that is there, and replaces that by renaming: a kill, a full disk or a power cut leaves
// the one or the other, each whole, which any program can read. Where the file has grown
// beyond PIECE_BYTES it is put aside as a piece, which is not written again, and a new one goes on
// (io/hdf5/array_pieces); the end joins them. HDF5's own way, SWMR, allows no new arrays or
// attributes while writing, takes twice the time, marks a killed writer's file so that ordinary
// readers refuse it, and has HDF5 write to a disk that may be full, on which it crashes.
#include "io/hdf5/array_file.h"

#include "base/memory.h"
#include "base/transfer.h"
#include "io/files/file_lock.h"
#include "io/files/part_file.h"
#include "io/hdf5/array_pieces.h"

#include <errno.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define FIRST_PIECE ".part.1"
enum { FIRST_SERIES = 16 };   // room for series before the list grows
// Written at each flush at most; the files of most runs are smaller.
enum { PIECE_BYTES = 8 << 20 };

struct ArrayFile {
    const ArrayFileModule *module;   // stands first
    char path[PATH_MAX + 8];   // what is read, or what a written file will be called
    hid_t id;   // of the file in memory, or of the one that is read; 0: not open
    ArrayPieces pieces;   // of which `id` is the last
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

// A new file in memory goes on after `from`, and takes the place of file->id.
static bool put_aside(ArrayFile *file, hid_t from, Error *err)
{
    const char *path = file->part.part;
    hid_t next = hdf5_memory_create(path, err);
    file->broken = true;   // should it end half done
    if (next < 0 || !array_pieces_begin(from, next, true, path, err)) return false;
    for (int32_t s = 0; s < file->series_count; s++)
        if (!series_move(&file->series[s], next, path, err)) return false;
    file->broken = false;
    if (file->id > 0) H5Fclose(file->id);
    file->id = file->pieces.last = next;
    file->pieces.count++;
    return true;
}

// Two turns where the file has become too large.
static bool hdf5_flush(ArrayFile *file, Error *err)
{
    char name[PATH_MAX + 24];
    const char *last = file->part.part;
    struct stat status;
    PartFile next = {0};
    void *bytes = NULL;
    if (!file->writing) return true;

    // Somebody may have removed or cut the last piece, which is written again; earlier ones are
    // lost.
    if (!file_is_named(last, file->part.descriptor) || fstat(file->part.descriptor, &status) != 0 ||
        status.st_size != file->flushed)
        file->changed = true;
    for (int32_t number = 1; number <= file->pieces.count; number++) {
        array_piece_name(&file->pieces, number, name);
        if (lstat(name, &status) != 0 || !S_ISREG(status.st_mode))
            return FAULT(err, ERROR_FILE,
                         "%s is gone, and with it the rows of the history that it held", name);
    }
    if (!file->changed) return true;
    if (!may_change(file, err) || !hand_over_all(file, err)) return false;
    while (file->changed) {
        int64_t size = 0;
        bytes = hdf5_memory_bytes(file->id, last, &size, err);
        if (!bytes) {
            file->broken = err->code == ERROR_LIBRARY;
            return false;
        }
        if (size > PIECE_BYTES) {
            // The bytes become a piece of their own.
            snprintf(name, sizeof name, "%s.%d", last, (int)file->pieces.count + 1);
            TRY(part_file_put(name, true, bytes, size, err));
            TRY(put_aside(file, file->id, err));
        } else {
            // They become the last piece. What was a piece without a number gets one first: a kill
            // between the two leaves that one alone (FIRST_PIECE).
            TRY(part_file_begin_next(&file->part, &next, err));
            TRY(part_file_write(&next, bytes, size, err));
            bool moved = file->pieces.unnamed;
            snprintf(name, sizeof name, "%s.%d", last, (int)file->pieces.count);
            if (moved && rename(last, name) != 0)
                FAIL(err, ERROR_FILE, "cannot rename %s to %s: %s", last, name, strerror(errno));
            file->pieces.unnamed = false;
            if (!part_file_take_next(&file->part, &next, err)) {
                if (moved) file->pieces.unnamed = rename(name, last) == 0;
                goto cleanup;
            }
            file->changed = false;
        }
        H5free_memory(bytes);
        bytes = NULL;
        file->flushed = size;
    }
cleanup:
    part_file_discard(&next);
    if (bytes) H5free_memory(bytes);
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
    file->pieces = (ArrayPieces){.path = file->part.part, .last = file->id};
    return file;
cleanup:
    part_file_discard(&file->part);
    destroy(file);
    return NULL;
}

// Nothing is written before the first flush; a finished file is called .part again.
static ArrayFile *hdf5_reopen(const char *path, Error *err)
{
    char first[PATH_MAX + 24], part[PATH_MAX + 24], *bytes = NULL;
    hid_t before = -1;
    struct stat status;
    ArrayFile *file = new_file(err);
    if (!file) return NULL;
    file->writing = true;
    file->series_capacity = FIRST_SERIES;
    TRY((file->series = NEW_ARRAY(SeriesWriter, file->series_capacity, err)));

    // A file that was killed while it became a piece is what it was.
    snprintf(part, sizeof part, "%.*s.part", PATH_MAX, path);
    snprintf(first, sizeof first, "%.*s" FIRST_PIECE, PATH_MAX, path);
    if (access(path, F_OK) != 0 && access(part, F_OK) != 0) rename(first, part);
    TRY(part_file_reopen(&file->part, path, err));
    const char *last = file->part.part;
    snprintf(file->path, sizeof file->path, "%s", path);
    file->pieces = (ArrayPieces){.path = last};
    if (fstat(file->part.descriptor, &status) != 0)
        FAIL(err, ERROR_FILE, "cannot read %s: %s", last, strerror(errno));
    file->flushed = status.st_size;
    if (status.st_size > PIECE_BYTES) {
        // A file of any length, as the end joins them, stays where it is and becomes a piece.
        TRY((before = hdf5_disk_open(last, err)) >= 0);
        TRY(array_pieces_count(before, last, &file->pieces.count, err));
        TRY(put_aside(file, before, err));
        file->pieces.unnamed = true;
        H5Fclose(before);
    } else {
        // A short one is read into the memory.
        TRY(bytes = memory_bytes(status.st_size, err));
        if (transfer_read(file->part.descriptor, bytes, status.st_size, 0) != status.st_size)
            FAIL(err, ERROR_FILE, "cannot read %s: %s", last, strerror(errno ? errno : EIO));
        TRY((file->id = hdf5_memory_open(last, bytes, status.st_size, err)) > 0);
        TRY(array_pieces_count(file->id, last, &file->pieces.count, err));
        memory_free(bytes);
    }
    file->pieces.last = file->id;
    return file;
cleanup:
    if (before >= 0) H5Fclose(before);
    memory_free(bytes);
    destroy(file);
    return NULL;
}

// Opens `path` or, where only that stands, `path`.part or FIRST_PIECE.
static ArrayFile *hdf5_open(const char *path, Error *err)
{
    static const char *const ends[] = {"", ".part", FIRST_PIECE};
    char part[PATH_MAX + 8];
    int cause = 0;
    bool found = false;
    ArrayFile *file = new_file(err);
    if (!file) return NULL;
    if (!part_file_name(path, part))
        FAIL(err, ERROR_FILE, "the name of the file to read is empty or too long: \"%s\"", path);
    for (size_t k = 0; !found && k < sizeof ends / sizeof ends[0]; k++) {
        snprintf(file->path, sizeof file->path, "%s%s", path, ends[k]);
        found = access(file->path, F_OK) == 0;
        if (k == 0) cause = errno;
    }
    if (!found)
        FAIL(err, ERROR_FILE, "cannot read %s (nor %s.part): %s", path, path, strerror(cause));
    TRY((file->id = hdf5_disk_open(file->path, err)) > 0);
    file->pieces = (ArrayPieces){.path = file->path, .last = file->id};
    TRY(array_pieces_count(file->id, file->path, &file->pieces.count, err));
    return file;
cleanup:
    destroy(file);
    return NULL;
}

// Where closing fails, the file keeps the name `path`.part.
static bool hdf5_close(ArrayFile *file, Error *err)
{
    char name[PATH_MAX + 24];
    PartFile next = {0};
    if (!file->writing) goto cleanup;
    TRY(hdf5_flush(file, err));
    if (file->pieces.count > 0) {
        // All pieces into one file, which takes the place of the last. Where HDF5 cannot write it,
        // it is left open (io/hdf5/hdf5_library).
        TRY(part_file_begin_next(&file->part, &next, err));
        hid_t whole = hdf5_disk_create(next.part, err);
        if (whole < 0 || !array_pieces_join(&file->pieces, whole, err)) {
            error_context(err, "the parts of %s cannot be joined", file->path);
            goto cleanup;
        }
        TRY(wrote(file, H5Fclose(whole), "the end", err));
        TRY(part_file_take_next(&file->part, &next, err));
    }
    TRY(part_file_commit(&file->part, err));
    for (int32_t number = file->pieces.count; number > 0; number--) {
        array_piece_name(&file->pieces, number, name);
        unlink(name);
    }
cleanup:
    part_file_discard(&next);
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

// A series of a reopened file is opened when it is first cut.
static bool hdf5_cut(ArrayFile *file, const char *name, int64_t rows, Error *err)
{
    SeriesWriter opened = {0}, *series = find_series(file, name);
    TRY(may_change(file, err));
    if (!series) {
        TRY(memory_grow(&file->series, file->series_count, &file->series_capacity,
                        sizeof *file->series, err));
        TRY(series_open(&opened, file->id, name, err));
        series = &file->series[file->series_count++];
        *series = opened;
        opened = (SeriesWriter){0};   // the list owns it now
    }
    TRY(series_cut(series, file->part.part, rows, err));
cleanup:
    series_destroy(&opened);
    return error_is_clean(err);
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
    *values = NULL;
    *rows = *width = 0;
    return hand_over_all(file, err) &&
           array_pieces_read(&file->pieces, name, values, rows, width, err);
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
