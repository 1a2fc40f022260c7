// SPDX-License-Identifier: GPL-2.0-or-later
// The tables of io/hdf5/result_tables.h, expanded once into arrays of rows, over which writer and
// readers loop. The index of an array is the enum made from the same table.
#include "io/hdf5/result_file.h"

#include "base/memory.h"
#include "io/files/folder.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

enum { FORMAT_VECTORS = 2 };   // the latest; 1 says nothing of itself

// Row of any of the six tables.
typedef struct ResultRow {
    const char *name;   // in the file, with its folder
    ArrayType type;   // as stored; attributes are always doubles
    ResultColumns columns;
    const char *unit;   // a dimension in words, "1" for none
    const char *description;
} ResultRow;

static const ResultRow series_rows[] = {
#define X(symbol, name, type, columns, unit, description)                                          \
    {name, type, COLUMNS_##columns, unit, description},
    RESULT_SERIES(X)
#undef X
};

static const ResultRow nodes_rows[] = {
#define X(symbol, name, type, unit, description) {name, type, COLUMNS_NODES, unit, description},
    RESULT_NODES(X)
#undef X
};

static const ResultRow faces_rows[] = {
#define X(symbol, name, type, unit, description) {name, type, COLUMNS_ONE, unit, description},
    RESULT_FACES(X)
#undef X
};

static const ResultRow probes_rows[] = {
#define X(symbol, name, type, unit, description) {name, type, COLUMNS_ONE, unit, description},
    RESULT_PROBES(X)
#undef X
};

static const ResultRow table_rows[] = {
#define X(symbol, name, unit, description) {name, ARRAY_FLOAT64, COLUMNS_ONE, unit, description},
    RESULT_TABLES(X)
#undef X
};

static const ResultRow number_rows[] = {
#define X(symbol, name, unit, description) {name, ARRAY_FLOAT64, COLUMNS_ONE, unit, description},
    RESULT_NUMBERS(X)
#undef X
};

const char *result_series_name(ResultSeries series)
{
    return series_rows[series].name;
}

const char *result_table_name(ResultTable table)
{
    return table_rows[table].name;
}

const char *result_number_name(ResultNumber number)
{
    return number_rows[number].name;
}

ResultColumns result_series_columns(ResultSeries series)
{
    return series_rows[series].columns;
}

bool result_series_written(const ResultHead *head, ResultSeries series)
{
    if (series == SERIES_ROD_WAY) return head->rod_on_spring;
    if (series == SERIES_STATE) return head->states > 0;
    if (result_series_columns(series) == COLUMNS_PROBES) return head->probes > 0;
    if (series == SERIES_AREA) return head->has_area;
    bool across = series == SERIES_PAD_SHEAR_ACROSS || series == SERIES_PAD_SLIP_ACROSS;
    return !across || head->tangents > 1;
}

static bool history_path(const char *folder, char path[PATH_MAX], Error *err)
{
    int length = snprintf(path, PATH_MAX, "%s/history.h5", folder);
    if (length < 0 || length >= PATH_MAX)
        return REFUSE(err, "the name of the result folder is too long: %s", folder);
    return true;
}

// --- writing ------------------------------------------------------------------------------------

// Number of components of a row. Quantities with a direction on the contact are vectors, and so are
// several states.
static int32_t row_components(const ResultRow *row, const ResultHead *head)
{
    static const ResultSeries vectors[] = {SERIES_SLIP_RATE, SERIES_SLIP, SERIES_SHEAR};
    for (size_t k = 0; k < sizeof vectors / sizeof vectors[0]; k++)
        if (row == &series_rows[vectors[k]] && head->tangents > 1) return head->tangents;
    int32_t dim = head->tangents > 1 ? 3 : 2;
    if (row == &series_rows[SERIES_PROBE_STRAIN] || row == &series_rows[SERIES_PROBE_STRESS])
        return dim * (dim + 1) / 2;
    if (row->columns == COLUMNS_PROBES) return dim;
    return row == &series_rows[SERIES_STATE] && head->states > 1 ? head->states : 1;
}

// Numbers in a row of a series: one, or some of each contact node, pad or probe. Pads are numbered
// from 0.
static int32_t series_width(const ResultRow *row, const ResultHead *head)
{
    double last_pad = 0;
    switch (row->columns) {
    case COLUMNS_NODES:
        return head->contact_count * row_components(row, head);
    case COLUMNS_PROBES:
        return head->probes * row_components(row, head);
    case COLUMNS_PADS:
        for (int32_t i = 0; i < head->contact_count; i++)
            last_pad = fmax(last_pad, head->nodes[NODES_PAD][i]);
        return (int32_t)last_pad + 1;
    default:
        return 1;
    }
}

// Makes the array of a table's row, empty.
static bool add_row(ArrayFile *file, const ResultRow *row, int32_t width, const ResultHead *head,
                    Error *err)
{
    char words[200];
    bool space = head->tangents > 1, states = row == &series_rows[SERIES_STATE];

    // The tables give the units in the plane, where all is per width. In space an entry is for the
    // row of this name, or for all rows of this unit.
    static const char *const units[][2] = {{"force/width", "force"},
                                           {"energy/width", "energy"},
                                           {"nodes/weight", "length^2"},
                                           {"pads/slipping", "length^2"}};
    const char *unit = row->unit;
    for (size_t k = 0; space && k < sizeof units / sizeof units[0]; k++)
        if (strcmp(units[k][0], row->unit) == 0 || strcmp(units[k][0], row->name) == 0)
            unit = units[k][1];
    if (states && head->state_unit) unit = head->state_unit;
    int32_t components = row_components(row, head);
    bool probes = row->columns == COLUMNS_PROBES;
    const char *more = states ? "; then the next state" : "; then the same along y";
    snprintf(words, sizeof words, "%s%s", row->description, components > 1 && !probes ? more : "");
    ArraySeries series = {
        .name = row->name, .type = row->type, .width = width, .unit = unit, .description = words};
    return array_file_add_vectors(file, &series, components, err);
}

static const ResultHead flat = {.tangents = 1};   // of arrays without directions

// Nodes are written now; series are made, empty, and grow as the run goes on.
ArrayFile *result_file_create(const char *folder, const ResultHead *head, Error *err)
{
    char path[PATH_MAX];
    ArrayFile *file = NULL;
    if (head->contact_count < 1)
        FAIL(err, ERROR_INPUT, "a result needs contact nodes, not %d of them", head->contact_count);
    TRY(history_path(folder, path, err));
    TRY((file = array_file_create(path, err)));

    // Attributes: texts, and the numbers known by now.
    TRY(array_file_set_text(file, "title", head->title, err));
    TRY(array_file_set_text(file, "units", head->units, err));
    TRY(array_file_set_text(file, "version", head->version, err));
    if (head->pads) TRY(array_file_set_text(file, "pads", head->pads, err));
    if (head->state_names && *head->state_names)
        TRY(array_file_set_text(file, "states", head->state_names, err));
    if (head->state_unit && head->states > 0)
        TRY(array_file_set_text(file, "state_unit", head->state_unit, err));
    if (head->probes > 0) TRY(array_file_set_text(file, "probes", head->probe_names, err));
    if (head->tangents > 1)
        TRY(array_file_set_number(file, number_rows[NUMBER_FORMAT].name, FORMAT_VECTORS, err));
    for (int32_t k = 0; k < RESULT_NUMBERS_COUNT; k++)
        if (k != NUMBER_FORMAT && !isnan(head->numbers[k]))
            TRY(array_file_set_number(file, number_rows[k].name, head->numbers[k], err));

    // Fixed arrays.
    for (int32_t k = 0; k < RESULT_NODES_COUNT; k++) {
        if (!head->nodes[k]) continue;
        TRY(add_row(file, &nodes_rows[k], 1, head, err));
        TRY(array_file_append(file, nodes_rows[k].name, head->nodes[k], head->contact_count, err));
    }
    for (int32_t k = 0; k < RESULT_FACES_COUNT; k++) {
        if (head->faces[k].rows == 0) continue;
        TRY(add_row(file, &faces_rows[k], head->faces[k].width, &flat, err));
        TRY(array_file_append(file, faces_rows[k].name, head->faces[k].values, head->faces[k].rows,
                              err));
    }
    if (head->probes > 0) {
        const ResultRow *row = &probes_rows[PROBES_AT];
        TRY(add_row(file, row, head->tangents > 1 ? 3 : 2, &flat, err));
        TRY(array_file_append(file, row->name, head->probe_places, head->probes, err));
    }

    // Series, empty.
    for (int32_t k = 0; k < RESULT_SERIES_COUNT; k++) {
        const ResultRow *row = &series_rows[k];
        if (result_series_written(head, (ResultSeries)k))
            TRY(add_row(file, row, series_width(row, head), head, err));
    }
    TRY(array_file_flush(file, err));   // from here on a killed run leaves a readable history
    return file;
cleanup:
    array_file_abandon(file);
    return NULL;
}

// Every series that will be written must be as this run would have made it: rows are copied from
// arrays of the run, which are as long as the run's own series are wide. Then what is known only at
// the end of a run is removed.
ArrayFile *result_file_reopen(const char *folder, const ResultHead *head, Error *err)
{
    char path[PATH_MAX];
    ArrayFile *file = NULL;
    TRY(history_path(folder, path, err));
    TRY((file = array_file_reopen(path, err)));
    for (int32_t k = 0; k < RESULT_SERIES_COUNT; k++) {
        const ResultRow *row = &series_rows[k];
        const ArraySeries series = {
            .name = row->name, .type = row->type, .width = series_width(row, head)};
        if (result_series_written(head, (ResultSeries)k))
            TRY(array_file_take_up(file, &series, row_components(row, head), err));
    }
    for (int32_t k = 0; k < RESULT_TABLES_COUNT; k++)
        TRY(array_file_remove(file, table_rows[k].name, err));
    TRY(array_file_remove(file, number_rows[NUMBER_MU_M].name, err));
    TRY(array_file_remove(file, number_rows[NUMBER_L_C].name, err));
    TRY(array_file_remove(file, "warnings", err));
    return file;
cleanup:
    array_file_abandon(file);
    return NULL;
}

bool result_file_cut(ArrayFile *file, const bool written[RESULT_SERIES_COUNT], int64_t rows,
                     Error *err)
{
    for (int32_t k = 0; k < RESULT_SERIES_COUNT; k++)
        if (written[k] && !array_file_cut(file, series_rows[k].name, rows, err)) return false;
    return true;
}

// Tables (peaks, events) are known at the end only, and are added then.
bool result_file_write_table(ArrayFile *file, ResultTable table, const double *values,
                             int32_t count, Error *err)
{
    return add_row(file, &table_rows[table], 1, &flat, err) &&
           array_file_append(file, table_rows[table].name, values, count, err);
}

// --- reading ------------------------------------------------------------------------------------

// A run that was killed has history.h5.part, which array_file_open takes where nothing else stands.
ArrayFile *result_file_open(const char *folder, Error *err)
{
    char path[PATH_MAX];
    if (!history_path(folder, path, err) || !folder_check_inside(folder, "history.h5", err) ||
        !folder_check_inside(folder, "history.h5.part", err))
        return NULL;
    ArrayFile *file = array_file_open(path, err);
    if (!file && err->code == ERROR_FILE) {
        err->code = ERROR_INPUT;   // the folder is what the user gave
        error_context(err, "%s holds no history of a run", folder);
    }
    if (file && result_file_number(file, NUMBER_FORMAT) > FORMAT_VECTORS) {
        error_set(err, ERROR_INPUT, __FILE__, __LINE__,
                  "the history in %s was written by a later version of amontons", folder);
        array_file_abandon(file);
        file = NULL;
    }
    return file;
}

// Numbers of a file may be anybody's. None is infinite or beyond this, whose square is one, too.
static const double NUMBER_MAX = 1e100;

static bool check_numbers(const char *name, const double *values, int64_t count, Error *err)
{
    for (int64_t k = 0; k < count; k++)
        if (fabs(values[k]) > NUMBER_MAX)
            return FAULT(err, ERROR_FILE, "%s holds %g, beyond all measure: the file is damaged",
                         name, values[k]);
    return true;
}

// Checks that counts, numbers and choices are whole and in their range, as they become indices.
static bool check_whole(const char *name, const double *values, int64_t count, double low,
                        double high, Error *err)
{
    for (int64_t k = 0; k < count; k++)
        if (!(values[k] >= low && values[k] <= high && values[k] == floor(values[k])))
            return FAULT(err, ERROR_FILE,
                         "%s holds %g, and not a whole number from %g to %g: the file is damaged",
                         name, values[k], low, high);
    return true;
}

// An array whose numbers were refused is freed.
static bool keep(bool good, double **values)
{
    if (good) return true;
    memory_free(*values);
    *values = NULL;
    return false;
}

// A fixed array: as `array_file_read`, its rows as a count; missing: none.
static bool read_column(ArrayFile *file, const char *name, double **values, int32_t *count,
                        Error *err)
{
    int64_t rows = 0;
    int32_t width = 0;
    *count = 0;
    if (!array_file_read(file, name, values, &rows, &width, err)) return false;
    if (rows > INT32_MAX || width != 1) {
        memory_free(*values);
        *values = NULL;
        return REFUSE(err, "%s is not one column but %lld rows of %d", name, (long long)rows,
                      width);
    }
    *count = (int32_t)rows;
    return keep(check_numbers(name, *values, rows, err), values);
}

bool result_file_has_faces(ArrayFile *file)
{
    return array_file_has(file, faces_rows[FACES_NODES].name);
}

bool result_file_has_series(ArrayFile *file, ResultSeries series)
{
    return array_file_has(file, series_rows[series].name);
}

bool result_file_read_faces(ArrayFile *file, ResultFaces faces, double **values, int32_t *rows,
                            int32_t *width, Error *err)
{
    const char *name = faces_rows[faces].name;
    double *nodes = NULL, *corners = NULL;
    int32_t node_count = 0, corner_count = 0, two = 0;
    int64_t count = 0;
    *rows = *width = 0;
    *values = NULL;
    if (!array_file_has(file, name)) return true;
    if (!array_file_read(file, name, values, &count, width, err)) return false;
    TRY(check_numbers(name, *values, count * *width, err));
    if (count > INT32_MAX) FAIL(err, ERROR_FILE, "%s is too long", name);
    if (faces == FACES_NODES) {
        // Points of faces: contact nodes, behind them corners; -1: none.
        TRY(result_file_read_nodes(file, NODES_X, &nodes, &node_count, err));
        TRY(result_file_read_faces(file, FACES_CORNERS, &corners, &corner_count, &two, err));
        TRY(check_whole(name, *values, count * *width, -1, (double)node_count + corner_count - 1,
                        err));
    }
cleanup:
    *rows = (int32_t)count;
    memory_free_all(nodes, corners);
    return keep(error_is_clean(err), values);
}

// length: who reads several takes the shortest.
bool result_file_read_series(ArrayFile *file, ResultSeries series, double **values, int64_t *rows,
                             int32_t *width, Error *err)
{
    const char *name = series_rows[series].name;
    if (!array_file_read(file, name, values, rows, width, err)) return false;
    int64_t count = *rows * *width;
    bool good = check_numbers(name, *values, count, err);
    if (good && series == SERIES_STATUS) good = check_whole(name, *values, count, 0, 3, err);
    if (good && series == SERIES_CERTIFIED) good = check_whole(name, *values, count, 0, 1, err);
    return keep(good, values);
}

bool result_file_read_nodes(ArrayFile *file, ResultNodes nodes, double **values, int32_t *count,
                            Error *err)
{
    const char *name = nodes_rows[nodes].name;
    if (!read_column(file, name, values, count, err)) return false;
    bool good = true;
    if (nodes == NODES_PAD) good = check_whole(name, *values, *count, 0, *count - 1, err);
    if (nodes == NODES_LINE) good = check_whole(name, *values, *count, 0, 1, err);
    return keep(good, values);
}

bool result_file_has_nodes(ArrayFile *file, ResultNodes nodes)
{
    return array_file_has(file, nodes_rows[nodes].name);
}

// A run that did not end has no tables: an empty one is given.
bool result_file_read_table(ArrayFile *file, ResultTable table, double **values, int32_t *count,
                            Error *err)
{
    const char *name = table_rows[table].name;
    if (array_file_has(file, name)) {
        if (!read_column(file, name, values, count, err)) return false;
        bool good = true;
        if (table == EVENTS_KIND) good = check_whole(name, *values, *count, 0, 3, err);
        if (table == PEAKS_COUNTS) good = check_whole(name, *values, *count, 0, 1, err);
        return keep(good, values);
    }
    *count = 0;
    *values = NEW_ARRAY(double, 0, err);
    return *values != NULL;
}

bool result_file_read_tables(ArrayFile *file, const ResultTable *tables, int32_t table_count,
                             double **columns, int32_t *count, Error *err)
{
    for (int32_t k = 0; k < table_count; k++) {
        int32_t rows = 0;
        if (!result_file_read_table(file, tables[k], &columns[k], &rows, err)) return false;
        if (k == 0) *count = rows;
        if (rows != *count)
            return FAULT(err, ERROR_FILE, "%s has %d rows, %s %d", table_rows[tables[0]].name,
                         *count, table_rows[tables[k]].name, rows);
    }
    return true;
}

// NaN: the file does not have it, as an older one may not; or it cannot be.
double result_file_number(ArrayFile *file, ResultNumber number)
{
    Error absent = {0};
    double value = NAN;
    array_file_get_number(file, number_rows[number].name, &value, &absent);
    return fabs(value) <= NUMBER_MAX ? value : (double)NAN;
}

bool result_file_text(ArrayFile *file, const char *name, char *value, int32_t size, Error *err)
{
    return array_file_get_text(file, name, value, size, err);
}
