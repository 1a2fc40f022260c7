// SPDX-License-Identifier: GPL-2.0-or-later
// With 81 contact nodes a row of all series of io/hdf5/result_file takes a microsecond; with
// compression, when a chunk is full, 15 to 20.
#include "io/hdf5/array_series.h"

#include "base/memory.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum {
    CHUNK_BYTES = 64 * 1024,   // aimed at; larger ones compress no better and flush slower
    CHUNK_ROWS_MAX = 1024,   // so a scalar series is flushed in pieces of 8 kB
    CACHE_SLOTS = 11,   // of HDF5's table of cached chunks; a prime, as it wants
    DEFLATE_LEVEL = 2   // 4 saves 4 % of the size and costs 20 % more time
};

// Bytes of a value, and its HDF5 types: in the file little-endian, whatever the machine, in the
// buffer the machine's own; HDF5 converts on the way.
typedef struct TypeRow {
    size_t size;
    hid_t stored, memory;
} TypeRow;

// HDF5 makes its types when it is first used, so the table cannot be a constant.
static TypeRow type_row(ArrayType type)
{
    const TypeRow rows[] = {[ARRAY_FLOAT64] = {sizeof(double), H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE},
                            [ARRAY_FLOAT32] = {sizeof(float), H5T_IEEE_F32LE, H5T_NATIVE_FLOAT},
                            [ARRAY_UINT8] = {sizeof(uint8_t), H5T_STD_U8LE, H5T_NATIVE_UINT8},
                            [ARRAY_INT32] = {sizeof(int32_t), H5T_STD_I32LE, H5T_NATIVE_INT32}};
    return rows[type];
}

// Scalars have one dimension, so that h5py users need not index a column.
static int rank_of(const SeriesWriter *writer)
{
    return writer->components > 1 ? 3 : writer->width > 1 ? 2 : 1;
}

// Shape of a part with so many rows. The rank says how many of its dimensions count.
static void shape_of(const SeriesWriter *writer, hsize_t rows, hsize_t shape[ARRAY_RANK_MAX])
{
    shape[0] = rows;
    shape[1] = (hsize_t)(writer->width / writer->components);
    shape[2] = (hsize_t)writer->components;
}

static int64_t chunk_rows(ArrayType type, int32_t width)
{
    int64_t rows = CHUNK_BYTES / ((int64_t)type_row(type).size * width);
    return rows < 1 ? 1 : rows > CHUNK_ROWS_MAX ? CHUNK_ROWS_MAX : rows;
}

// A chunk is compressed and read as one. The buffer holds one.
bool series_create(SeriesWriter *writer, hid_t id, const ArraySeries *series, int32_t components,
                   Error *err)
{
    char cause[HDF5_CAUSE_SIZE];
    *writer =
        (SeriesWriter){.type = series->type, .width = series->width, .components = components};
    if (series->width < 1 || series->width % components != 0 || series->type > ARRAY_INT32)
        return FAULT(err, ERROR_LIBRARY, "%s has no values or no type", series->name);
    writer->chunk_rows = chunk_rows(series->type, series->width);
    if (!(writer->name = memory_text(series->name, err))) return false;
    if (!(writer->buffer =
              memory_array(writer->chunk_rows * writer->width, type_row(writer->type).size, err)))
        return false;

    // An empty, extendable dataset.
    hsize_t shape[ARRAY_RANK_MAX], shape_max[ARRAY_RANK_MAX], chunk[ARRAY_RANK_MAX];
    shape_of(writer, 0, shape);
    shape_of(writer, H5S_UNLIMITED, shape_max);
    shape_of(writer, (hsize_t)writer->chunk_rows, chunk);
    size_t chunk_bytes = (size_t)(writer->chunk_rows * writer->width) * type_row(writer->type).size;
    hid_t space = H5Screate_simple(rank_of(writer), shape, shape_max);
    hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
    hid_t links = H5Pcreate(H5P_LINK_CREATE);
    hid_t cache = H5Pcreate(H5P_DATASET_ACCESS);
    bool ready = H5Pset_chunk(creation, rank_of(writer), chunk) >= 0 &&
                 H5Pset_shuffle(creation) >= 0 && H5Pset_deflate(creation, DEFLATE_LEVEL) >= 0 &&
                 H5Pset_create_intermediate_group(links, 1) >= 0 &&
                 // Only the last chunk is ever touched again; a full one leaves memory first (1.0).
                 H5Pset_chunk_cache(cache, CACHE_SLOTS, chunk_bytes, 1.0) >= 0;
    writer->dataset = !ready ? -1
                             : H5Dcreate2(id, writer->name, type_row(writer->type).stored, space,
                                          links, creation, cache);
    H5Pclose(cache);
    H5Pclose(links);
    H5Pclose(creation);
    H5Sclose(space);
    if (writer->dataset < 0)
        return FAULT(err, ERROR_LIBRARY, "HDF5 cannot make %s: %s", writer->name,
                     hdf5_cause(cause));
    return true;
}

// The numbers come from a file, which may be damaged: bytes of all values must fit into 64 bits.
bool series_shape(hid_t dataset, int64_t *rows, int32_t *width, int32_t *components,
                  char why[SHAPE_WHY_SIZE])
{
    hsize_t shape[ARRAY_RANK_MAX] = {0, 1, 1}, across = 0, most = INT64_MAX / sizeof(double);
    hid_t space = H5Dget_space(dataset);
    int rank = H5Sget_simple_extent_ndims(space);
    bool known = rank >= 1 && rank <= ARRAY_RANK_MAX;
    snprintf(why, SHAPE_WHY_SIZE, "has %d dimensions, not 1 to %d", rank, ARRAY_RANK_MAX);
    if (known) {
        snprintf(why, SHAPE_WHY_SIZE, "is too large to be true");
        known = H5Sget_simple_extent_dims(space, shape, NULL) >= 0 && shape[1] <= INT32_MAX &&
                shape[2] <= INT32_MAX && (across = shape[1] * shape[2]) <= INT32_MAX &&
                shape[0] <= most / (across > 0 ? across : 1);
    }
    H5Sclose(space);
    *rows = (int64_t)shape[0];
    *width = (int32_t)across;
    *components = (int32_t)shape[2];
    return known;
}

bool series_open(SeriesWriter *writer, hid_t id, const ArraySeries *series, int32_t components,
                 Error *err)
{
    char cause[HDF5_CAUSE_SIZE], why[SHAPE_WHY_SIZE];
    const char *name = series->name;
    int32_t width = 0, last = 0;
    *writer =
        (SeriesWriter){.type = series->type, .width = series->width, .components = components};
    if (!(writer->name = memory_text(name, err))) return false;
    // With a cache of a chunk, which is CHUNK_BYTES at most, or a row.
    hid_t cache = H5Pcreate(H5P_DATASET_ACCESS);
    H5Pset_chunk_cache(cache, CACHE_SLOTS, CHUNK_BYTES, 1.0);
    writer->dataset = H5Lexists(id, name, H5P_DEFAULT) > 0 ? H5Dopen2(id, name, cache) : -1;
    H5Pclose(cache);
    if (writer->dataset < 0)
        return FAULT(err, ERROR_FILE, "the file has no %s: %s", name, hdf5_cause(cause));

    // The file may be anybody's. Its chunks need not be those that series_create would give it.
    hid_t type = H5Dget_type(writer->dataset), space = H5Dget_space(writer->dataset);
    bool typed = H5Tequal(type, type_row(series->type).stored) > 0;
    bool ranked = H5Sget_simple_extent_ndims(space) == rank_of(writer);
    H5Tclose(type);
    H5Sclose(space);
    if (!series_shape(writer->dataset, &writer->row_count, &width, &last, why))
        return FAULT(err, ERROR_FILE, "%s %s", name, why);
    if (!typed || !ranked || width != writer->width || last != components)
        return REFUSE(err,
                      "%s is not as this run writes it: it has %d numbers a row, not %d, or they "
                      "have another type or shape; it is of another run, or damaged, and "
                      "--overwrite begins anew",
                      name, width, writer->width);
    writer->chunk_rows = chunk_rows(writer->type, writer->width);
    writer->buffer =
        memory_array(writer->chunk_rows * writer->width, type_row(writer->type).size, err);
    return writer->buffer != NULL;
}

// Buffered rows may be among those that go.
bool series_cut(SeriesWriter *writer, const char *path, int64_t rows, Error *err)
{
    hsize_t shape[ARRAY_RANK_MAX];
    if (!series_hand_over(writer, path, err)) return false;
    if (writer->row_count < rows)
        return FAULT(err, ERROR_FILE, "%s has %lld rows, %lld are to be kept", writer->name,
                     (long long)writer->row_count, (long long)rows);
    if (writer->row_count == rows) return true;
    shape_of(writer, (hsize_t)rows, shape);
    writer->row_count = rows;
    return hdf5_wrote(H5Dset_extent(writer->dataset, shape), path, writer->name, err);
}

void series_destroy(SeriesWriter *writer)
{
    if (writer->dataset > 0) H5Dclose(writer->dataset);
    memory_free_all(writer->name, writer->buffer);
    *writer = (SeriesWriter){0};
}

bool series_hand_over(SeriesWriter *writer, const char *path, Error *err)
{
    if (writer->buffered == 0) return true;
    // The dataset grows by the rows, which are the hyperslab that is written:
    //   [0, row_count) stays, [row_count, row_count + buffered) x [0, width) is `from` the buffer.
    hsize_t start[ARRAY_RANK_MAX] = {(hsize_t)writer->row_count};
    hsize_t count[ARRAY_RANK_MAX], shape[ARRAY_RANK_MAX];
    shape_of(writer, (hsize_t)writer->buffered, count);
    shape_of(writer, start[0] + count[0], shape);
    hid_t from = H5Screate_simple(rank_of(writer), count, NULL);
    hid_t to = -1;
    herr_t status = H5Dset_extent(writer->dataset, shape);
    if (status >= 0) to = H5Dget_space(writer->dataset);
    if (to >= 0) status = H5Sselect_hyperslab(to, H5S_SELECT_SET, start, NULL, count, NULL);
    if (to >= 0 && status >= 0)
        status = H5Dwrite(writer->dataset, type_row(writer->type).memory, from, to, H5P_DEFAULT,
                          writer->buffer);
    if (to >= 0) H5Sclose(to);
    H5Sclose(from);
    if (!hdf5_wrote(to < 0 ? -1 : status, path, writer->name, err)) return false;
    writer->row_count += writer->buffered;
    writer->buffered = 0;
    return true;
}

// The nearest integer within [low, high]; 0 for NaN, whose conversion C leaves undefined.
static double nearest(double value, double low, double high)
{
    if (isnan(value)) return 0.0;
    return value < low ? low : value > high ? high : rint(value);
}

// Appends in whole chunks: one that is not full would be compressed again with every row.
bool series_append(SeriesWriter *writer, const char *path, const double *values, int64_t rows,
                   Error *err)
{
    while (rows > 0) {
        int64_t into_chunk = writer->row_count % writer->chunk_rows + writer->buffered;
        int64_t room = writer->chunk_rows - into_chunk;
        int64_t taken = rows < room ? rows : room;

        // buffer[first ... first + count) = values, in the stored type.
        int64_t first = writer->buffered * writer->width, count = taken * writer->width;
        switch (writer->type) {
        case ARRAY_FLOAT64:
            memcpy((double *)writer->buffer + first, values, (size_t)count * sizeof(double));
            break;
        case ARRAY_FLOAT32:
            for (int64_t k = 0; k < count; k++)
                ((float *)writer->buffer)[first + k] = (float)values[k];
            break;
        case ARRAY_UINT8:
            for (int64_t k = 0; k < count; k++)
                ((uint8_t *)writer->buffer)[first + k] = (uint8_t)nearest(values[k], 0, UINT8_MAX);
            break;
        case ARRAY_INT32:
            for (int64_t k = 0; k < count; k++)
                ((int32_t *)writer->buffer)[first + k] =
                    (int32_t)nearest(values[k], INT32_MIN, INT32_MAX);
            break;
        }
        writer->buffered += taken;
        values += taken * writer->width;
        rows -= taken;
        if (taken == room && !series_hand_over(writer, path, err)) return false;
    }
    return true;
}
