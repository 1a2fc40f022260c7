// SPDX-License-Identifier: GPL-2.0-or-later
#include "io/hdf5/array_pieces.h"

#include "base/memory.h"

#include <stdio.h>
#include <string.h>

static const char COUNT[] = "parts";   // the attribute

enum { PIECES_MAX = 1000000 };
enum { BLOCK_BYTES = 1 << 22 };   // of rows that are copied at once

void array_piece_name(const ArrayPieces *pieces, int32_t number, char name[PATH_MAX + 24])
{
    if (pieces->unnamed && number == pieces->count)
        snprintf(name, PATH_MAX + 24, "%s", pieces->path);
    else
        snprintf(name, PATH_MAX + 24, "%s.%d", pieces->path, (int)number);
}

bool array_pieces_count(hid_t last, const char *path, int32_t *count, Error *err)
{
    double number = 0;
    *count = 0;
    if (H5Aexists(last, COUNT) <= 0) return true;
    if (attribute_read_number(last, COUNT, &number) < 0 || !(number >= 0 && number <= PIECES_MAX))
        return FAULT(err, ERROR_FILE, "%s: it says not how many parts it has", path);
    *count = (int32_t)number;
    return true;
}

// --- rows of one piece ---------------------------------------------------------------------------

// Rows [from, from + count) of the dataset, or into it, as values of `type`. The status is HDF5's.
static herr_t transfer_rows(hid_t dataset, hid_t type, int64_t from, int64_t count, void *values,
                            bool writing)
{
    hsize_t start[ARRAY_RANK_MAX] = {(hsize_t)from}, shape[ARRAY_RANK_MAX];
    hid_t space = H5Dget_space(dataset);
    int rank = H5Sget_simple_extent_dims(space, shape, NULL);
    shape[0] = (hsize_t)count;
    hid_t memory = rank < 1 ? -1 : H5Screate_simple(rank, shape, NULL);
    herr_t status =
        memory < 0 ? -1 : H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, shape, NULL);
    if (status >= 0)
        status = writing ? H5Dwrite(dataset, type, memory, space, H5P_DEFAULT, values)
                         : H5Dread(dataset, type, memory, space, H5P_DEFAULT, values);
    if (memory >= 0) H5Sclose(memory);
    H5Sclose(space);
    return status;
}

// Goes through the pieces that an array lies in, the last one first (next_piece).
typedef struct PieceArray {
    const ArrayPieces *pieces;
    const char *name;   // of the array
    int32_t number;   // of this piece, beyond pieces->count: the last; 0: none was asked for
    hid_t file, dataset;   // 0: not opened. file: only where it is an earlier piece
    char path[PATH_MAX + 24];
    int64_t first, rows;   // which rows of the whole array it has
    int64_t whole, begin;   // rows of the whole array; the first one of the pieces gone through
    int32_t width;
} PieceArray;

static void close_piece(PieceArray *piece)
{
    if (piece->dataset > 0) H5Dclose(piece->dataset);
    if (piece->file > 0) H5Fclose(piece->file);
    piece->dataset = piece->file = 0;
}

// Opens the array in the next piece. False: there is no more of it, or an error. The caller closes
// *piece in any case.
static bool next_piece(PieceArray *piece, Error *err)
{
    char cause[HDF5_CAUSE_SIZE], why[SHAPE_WHY_SIZE];
    const ArrayPieces *pieces = piece->pieces;
    const char *name = piece->name;
    int64_t rows;
    int32_t width, components;
    bool last = piece->number == 0;
    close_piece(piece);
    if (!last && piece->begin == 0) return false;
    piece->number = last ? pieces->count + 1 : piece->number - 1;
    if (piece->number == 0)
        return FAULT(err, ERROR_FILE, "%s: the first rows of %s are missing", pieces->path, name);

    // The piece, and the array in it.
    if (last) snprintf(piece->path, sizeof piece->path, "%s", pieces->path);
    if (!last) array_piece_name(pieces, piece->number, piece->path);
    if (!last && (piece->file = hdf5_disk_open(piece->path, err)) < 0) return false;
    hid_t file = last ? pieces->last : piece->file;
    if (H5Lexists(file, name, H5P_DEFAULT) <= 0)
        return FAULT(err, ERROR_FILE, "%s has no %s", piece->path, name);
    piece->dataset = H5Dopen2(file, name, H5P_DEFAULT);
    if (piece->dataset < 0)
        return FAULT(err, ERROR_FILE, "%s: %s is no array: %s", piece->path, name,
                     hdf5_cause(cause));
    if (!series_shape(piece->dataset, &rows, &width, &components, why))
        return FAULT(err, ERROR_FILE, "%s: %s %s", piece->path, name, why);
    piece->first = series_first_row(piece->dataset);
    if (piece->first < 0 || (piece->first > 0 && pieces->count == 0) ||
        piece->first > INT64_MAX - rows)
        return FAULT(err, ERROR_FILE, "%s: %s begins with a row that cannot be", piece->path, name);

    // Its rows count up to the first one of the piece behind it, and it must have them.
    if (last) {
        piece->whole = piece->begin = piece->first + rows;
        piece->width = width;
    }
    piece->rows = piece->begin > piece->first ? piece->begin - piece->first : 0;
    if (piece->rows > rows || (piece->rows > 0 && piece->width != width))
        return FAULT(err, ERROR_FILE,
                     "%s: rows of %s are missing: it is not the part that was "
                     "written",
                     piece->path, name);
    if (piece->first < piece->begin) piece->begin = piece->first;
    return true;
}

bool array_pieces_read(const ArrayPieces *pieces, const char *name, double **values, int64_t *rows,
                       int32_t *width, Error *err)
{
    char cause[HDF5_CAUSE_SIZE];
    PieceArray piece = {.pieces = pieces, .name = name};
    int64_t most = INT64_MAX / (int64_t)sizeof(double);
    double *read = NULL;
    while (next_piece(&piece, err)) {
        if (!read) {
            if (piece.whole > most / (piece.width > 0 ? piece.width : 1))
                FAIL(err, ERROR_FILE, "%s: %s is too large to be true", piece.path, name);
            TRY(read = memory_bytes(piece.whole * piece.width * (int64_t)sizeof(double), err));
        }
        if (piece.rows > 0 && transfer_rows(piece.dataset, H5T_NATIVE_DOUBLE, 0, piece.rows,
                                            read + piece.first * piece.width, false) < 0)
            FAIL(err, ERROR_FILE, "%s: cannot read %s: %s", piece.path, name, hdf5_cause(cause));
    }
cleanup:
    close_piece(&piece);
    if (!error_is_clean(err)) memory_free(read);   // half read
    bool done = error_is_clean(err);
    *values = done ? read : NULL;
    *rows = done ? piece.whole : 0;
    *width = done ? piece.width : 0;
    return done;
}

// --- another file with the same arrays ----------------------------------------------------------

typedef struct Beginning {
    hid_t to;
    bool goes_on;
    const char *path;
} Beginning;

static bool begin_array(hid_t dataset, const char *name, void *context, Error *err)
{
    const Beginning *beginning = context;
    char why[SHAPE_WHY_SIZE];
    int64_t rows, first = series_first_row(dataset);
    int32_t width, components;
    if (!series_shape(dataset, &rows, &width, &components, why))
        return FAULT(err, ERROR_FILE, "%s: %s %s", beginning->path, name, why);
    if (first < 0 || first > INT64_MAX - rows)
        return FAULT(err, ERROR_FILE, "%s: %s begins with a row that cannot be", beginning->path,
                     name);

    // Type, chunks and filters as they are, no rows.
    hsize_t shape[H5S_MAX_RANK], shape_max[H5S_MAX_RANK];
    hid_t type = H5Dget_type(dataset), given = H5Dget_space(dataset);
    hid_t creation = H5Dget_create_plist(dataset), links = H5Pcreate(H5P_LINK_CREATE);
    int rank = H5Sget_simple_extent_dims(given, shape, shape_max);
    shape[0] = 0;
    hid_t space = rank < 1 ? -1 : H5Screate_simple(rank, shape, shape_max);
    H5Pset_create_intermediate_group(links, 1);
    hid_t made =
        space < 0 ? -1 : H5Dcreate2(beginning->to, name, type, space, links, creation, H5P_DEFAULT);
    if (space >= 0) H5Sclose(space);
    H5Pclose(links);
    H5Pclose(creation);
    H5Sclose(given);
    H5Tclose(type);

    herr_t status = made < 0 ? -1 : attribute_copy_all(dataset, made, SERIES_FIRST_ROW);
    if (status >= 0 && beginning->goes_on)
        status = attribute_write_number(made, SERIES_FIRST_ROW, (double)(first + rows));
    bool done = hdf5_wrote(status, beginning->path, name, err);
    if (made >= 0) H5Dclose(made);
    return done;
}

bool array_pieces_begin(hid_t from, hid_t to, bool goes_on, const char *path, Error *err)
{
    int32_t count = 0;
    Beginning beginning = {to, goes_on, path};
    if (!array_pieces_count(from, path, &count, err)) return false;
    herr_t status = attribute_copy_all(from, to, COUNT);
    if (status >= 0 && goes_on) status = attribute_write_number(to, COUNT, count + 1);
    if (!hdf5_wrote(status, path, "its attributes", err)) return false;
    return hdf5_visit(from, path, begin_array, &beginning, err);
}

// --- all pieces in one ---------------------------------------------------------------------------

typedef struct Joining {
    const ArrayPieces *pieces;
    hid_t whole;   // the file
} Joining;

// Copies the rows of each piece to their place in the whole array, some at a time.
static bool join_array(hid_t last, const char *name, void *context, Error *err)
{
    const Joining *joining = context;
    const char *path = joining->pieces->path;
    char cause[HDF5_CAUSE_SIZE], *block = NULL;
    hid_t type = -1, to = H5Dopen2(joining->whole, name, H5P_DEFAULT);
    PieceArray piece = {.pieces = joining->pieces, .name = name};
    (void)last;
    TRY(hdf5_wrote(to < 0 ? -1 : 0, path, name, err));
    while (next_piece(&piece, err)) {
        type = H5Dget_type(piece.dataset);
        int64_t row_bytes = (int64_t)H5Tget_size(type) * piece.width, rows = piece.rows;
        int64_t most = row_bytes > 0 && row_bytes < BLOCK_BYTES ? BLOCK_BYTES / row_bytes : 1;
        TRY(block = memory_array(rows < most ? rows : most, (size_t)row_bytes, err));

        // The whole array gets its length with the first piece.
        hsize_t shape[H5S_MAX_RANK];
        hid_t space = H5Dget_space(to);
        H5Sget_simple_extent_dims(space, shape, NULL);
        H5Sclose(space);
        if (shape[0] != (hsize_t)piece.whole) {
            shape[0] = (hsize_t)piece.whole;
            TRY(hdf5_wrote(H5Dset_extent(to, shape), path, name, err));
        }
        for (int64_t done = 0; done < rows; done += most) {
            int64_t count = rows - done < most ? rows - done : most;
            if (transfer_rows(piece.dataset, type, done, count, block, false) < 0)
                FAIL(err, ERROR_FILE, "%s: cannot read %s: %s", piece.path, name,
                     hdf5_cause(cause));
            TRY(hdf5_wrote(transfer_rows(to, type, piece.first + done, count, block, true), path,
                           name, err));
        }
        memory_free(block);
        H5Tclose(type);
        block = NULL;
        type = -1;
    }
cleanup:
    close_piece(&piece);
    memory_free(block);
    if (type >= 0) H5Tclose(type);
    if (to >= 0) H5Dclose(to);
    return error_is_clean(err);
}

bool array_pieces_join(const ArrayPieces *pieces, hid_t whole, Error *err)
{
    Joining joining = {.pieces = pieces, .whole = whole};
    return array_pieces_begin(pieces->last, whole, false, pieces->path, err) &&
           hdf5_visit(pieces->last, pieces->path, join_array, &joining, err);
}
