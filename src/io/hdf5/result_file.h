// SPDX-License-Identifier: GPL-2.0-or-later
// Writes and reads the arrays of a result folder by the names of io/hdf5/result_tables.
// record/history writes by it; render/, page/ and run/ read by it.
//
//   RESULT/run.json        one object, written last (run/report)
//   RESULT/history.h5      the arrays and attributes below
//   RESULT/fields.pvd      the time series of fields/*.vtu and fields/*.vtp
//   RESULT/figures/*.png   pictures drawn from history.h5 alone
#ifndef AMONTONS_IO_HDF5_RESULT_FILE_H
#define AMONTONS_IO_HDF5_RESULT_FILE_H

#include "io/hdf5/array_file.h"
#include "io/hdf5/result_tables.h"

const char *result_series_name(ResultSeries series);
const char *result_table_name(ResultTable table);
const char *result_number_name(ResultNumber number);
ResultColumns result_series_columns(ResultSeries series);
typedef struct ResultHead ResultHead;
bool result_series_written(const ResultHead *head, ResultSeries series);

// Writing: creates RESULT/history.h5(.part) with the series of the table, empty, and the fixed
// arrays. `nodes[k]`: [contact_count] for each ResultNodes, y and line NULL in the plane;
// nodes[NODES_PAD] says how many pads.
struct ResultHead {
    const char *title, *units, *version;
    const char *pads;   // NULL: without names
    double numbers[RESULT_NUMBERS_COUNT];   // NaN: not known yet, not written
    bool goes_on;   // with the history that is there, finished or not: numbers and nodes are in it
    bool rod_on_spring;   // SERIES_ROD_WAY is written, too
    int32_t states;   // of a contact node, in SERIES_STATE; 0: there is none
    bool has_area;   // SERIES_AREA is written, too
    const char *state_names;   // a line each; NULL or empty: without names
    const char *state_unit;   // "time", "1" or "its own"; NULL: not known
    int32_t probes;   // 0: there are none
    const char *probe_names;   // a line each; NULL: there are none
    const double *probe_places;   // [probes * (tangents + 1)] length
    int32_t contact_count;
    int32_t tangents;   // directions of slip: 0 or 1 in the plane, 2 in space
    const double *nodes[RESULT_NODES_COUNT];
    struct {
        int32_t rows, width;   // 0: the array is left out
        const double *values;   // [rows * width]
    } faces[RESULT_FACES_COUNT];
};
ArrayFile *result_file_create(const char *folder, const ResultHead *head, Error *err);
// The history of RESULT, finished or not, to go on with; without the tables and numbers of an end.
// ERROR_INPUT: a series is not as result_file_create makes it of this head. ERROR_FILE: it is
// missing.
ArrayFile *result_file_reopen(const char *folder, const ResultHead *head, Error *err);
// Keeps the first `rows` steps of these series.
bool result_file_cut(ArrayFile *file, const bool written[RESULT_SERIES_COUNT], int64_t rows,
                     Error *err);
bool result_file_write_table(ArrayFile *file, ResultTable table, const double *values,
                             int32_t count, Error *err);

// Reading, for render/: one array at a time, on demand. NaN for an absent number; a missing table
// reads as 0 rows. `folder` is the result folder; ERROR_INPUT when it holds no history.
ArrayFile *result_file_open(const char *folder, Error *err);
bool result_file_read_series(ArrayFile *file, ResultSeries series, double **values, int64_t *rows,
                             int32_t *width, Error *err);
bool result_file_read_nodes(ArrayFile *file, ResultNodes nodes, double **values, int32_t *count,
                            Error *err);
bool result_file_has_nodes(ArrayFile *file, ResultNodes nodes);   // y and line: in space
bool result_file_has_faces(ArrayFile *file);
bool result_file_has_series(ArrayFile *file, ResultSeries series);   // older ones may lack some
// *values [rows * width]; an array that is absent has no rows.
bool result_file_read_faces(ArrayFile *file, ResultFaces faces, double **values, int32_t *rows,
                            int32_t *width, Error *err);
bool result_file_read_table(ArrayFile *file, ResultTable table, double **values, int32_t *count,
                            Error *err);
// Columns [table_count] of one table, owned by the caller also after a failure; count: rows of all.
// ERROR_FILE: they are not equally many, as in a damaged file.
bool result_file_read_tables(ArrayFile *file, const ResultTable *tables, int32_t table_count,
                             double **columns, int32_t *count, Error *err);
double result_file_number(ArrayFile *file, ResultNumber number);
bool result_file_text(ArrayFile *file, const char *name, char *value, int32_t size, Error *err);

#endif
