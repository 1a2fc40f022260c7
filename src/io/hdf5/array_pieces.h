// SPDX-License-Identifier: GPL-2.0-or-later
// A long file that is being written lies on the disk in pieces: `path`.part.1, .2, ... (whole HDF5
// files that are written once), and `path`.part, the last one, which is replaced as a whole at each
// flush. Every array goes on from piece to piece: its attribute "first_row" says which row of the
// whole array is its first. Rows that an earlier piece has beyond that count no more: the array was
// cut. The last piece's attribute "parts" says how many there are before it. Called by
// io/hdf5/array_file_module alone.
#ifndef AMONTONS_IO_HDF5_ARRAY_PIECES_H
#define AMONTONS_IO_HDF5_ARRAY_PIECES_H

#include "io/hdf5/array_series.h"

#include <limits.h>

typedef struct ArrayPieces {
    const char *path;   // of the last piece, without number; not owned
    hid_t last;   // that piece
    int32_t count;   // of pieces before it
    bool unnamed;   // number `count` is still called `path`
} ArrayPieces;

// The name of piece `number`, from 1 on.
void array_piece_name(const ArrayPieces *pieces, int32_t number, char name[PATH_MAX + 24]);

// Reads how many pieces come before the file `last`; ERROR_FILE: a number that cannot be.
bool array_pieces_count(hid_t last, const char *path, int32_t *count, Error *err);

// All rows of an array as doubles: *values [rows * width], the caller's (memory_free).
bool array_pieces_read(const ArrayPieces *pieces, const char *name, double **values, int64_t *rows,
                       int32_t *width, Error *err);

// Makes the arrays and attributes of the file `from` in the file `to`, without rows. goes_on: `to`
// is the piece after it.
bool array_pieces_begin(hid_t from, hid_t to, bool goes_on, const char *path, Error *err);

// Writes all arrays whole into the file `whole`.
bool array_pieces_join(const ArrayPieces *pieces, hid_t whole, Error *err);

#endif
