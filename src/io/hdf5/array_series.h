// SPDX-License-Identifier: GPL-2.0-or-later
// One growing dataset of an HDF5 file being written, and the rows that HDF5 has not got yet. Rows
// are collected in a buffer that is full where a chunk of the dataset ends: HDF5 gets whole chunks
// and compresses each once. Called by io/hdf5/array_file_module alone.
//
//   rows    0 ............ row_count ...... row_count + buffered
//           | with HDF5    | in `buffer`    |
//   chunks  |-----|-----|-----|    the buffer never reaches past the end of a chunk
#ifndef AMONTONS_IO_HDF5_ARRAY_SERIES_H
#define AMONTONS_IO_HDF5_ARRAY_SERIES_H

#include "io/hdf5/array_file.h"
#include "io/hdf5/hdf5_library.h"

typedef struct SeriesWriter {
    char *name;   // owned
    ArrayType type;   // as stored, in the file and in `buffer`
    int32_t width;   // values a row
    int32_t components;   // of a vector, their last axis; 1: they are numbers
    int64_t chunk_rows;   // rows of a chunk
    int64_t row_count;   // rows that HDF5 has
    int64_t buffered;   // rows after them, in `buffer`
    void *buffer;   // [chunk_rows * width] of the stored type; owned
    hid_t dataset;   // 0: none; owned
} SeriesWriter;

// `path` below names the file in messages.

// Makes the empty dataset in the HDF5 file `id`. A scalar series (width 1) has one dimension, one
// of vectors three, the others two. *writer is destroyed by the caller, also after a failure.
bool series_create(SeriesWriter *writer, hid_t id, const ArraySeries *series, int32_t components,
                   Error *err);
void series_destroy(SeriesWriter *writer);

// Rows of a dataset, values a row, and of a vector its components. false: none of ours, and why.
enum { SHAPE_WHY_SIZE = 60 };
bool series_shape(hid_t dataset, int64_t *rows, int32_t *width, int32_t *components,
                  char why[SHAPE_WHY_SIZE]);

// One that is in the file already; *writer as above. ERROR_INPUT: it is not as series_create makes
// it of these arguments, in type, width or components. Rows are taken at that width from memory.
bool series_open(SeriesWriter *writer, hid_t id, const ArraySeries *series, int32_t components,
                 Error *err);
// Only the first `rows` rows stay. ERROR_FILE: it has fewer.
bool series_cut(SeriesWriter *writer, const char *path, int64_t rows, Error *err);

// Takes `rows` rows of doubles, [rows * width], and hands full chunks on to HDF5.
bool series_append(SeriesWriter *writer, const char *path, const double *values, int64_t rows,
                   Error *err);
// Hands what is buffered to HDF5, which may still keep it in memory.
bool series_hand_over(SeriesWriter *writer, const char *path, Error *err);

#endif
