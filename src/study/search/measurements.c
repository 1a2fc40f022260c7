// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/search/measurements.h"

#include "base/memory.h"
#include "base/text.h"
#include "io/files/folder.h"
#include "io/files/open_file.h"
#include "io/hdf5/array_file.h"
#include "io/text/csv_reader.h"
#include "io/text/json_reader.h"
#include "scene/keys.h"
#include "study/sweep/reading/study.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

// Misfits are squares of differences over errors: none of them may overflow.
static const double LARGEST = 1e30, SMALLEST = 1e-30, DIGITS = 1e-12;   // DIGITS: of the value
static const char SERIES[] = "series/";
// Slide-hold-slide: the time that the rod was held, and what is measured when it goes on.
static const char HOLD[] = "hold", PEAK[] = "mu", HEALING[] = "healing";
static const char *const WORDED[] = {HOLD, PEAK};   // that may stand in words: "hold time (s)"

typedef enum ColumnKind { COLUMN_CONDITION, COLUMN_RESULT, COLUMN_ERROR, COLUMN_ALONG } ColumnKind;

typedef struct Column {
    char name[STUDY_NAME_SIZE];   // without its unit
    char unit[CSV_UNIT_SIZE];   // "": none
    double factor;   // of its numbers, to SI base units
    ColumnKind kind;
    int32_t error;   // of a result: the column of its error
} Column;

typedef struct Table {
    const char *path;
    CsvTable csv;
    Column *columns;   // [csv.columns] owned
} Table;

// --- columns ------------------------------------------------------------------------------------

static bool is_key(const char *name)
{
    const char *part;
    return scene_key_index(name) >= 0 || scene_key_above(name, &part) >= 0;
}

static bool is_series(const char *name)
{
    return strncmp(name, SERIES, sizeof SERIES - 1) == 0;
}

// A table of holds has `mu`, its peak after each, or `healing`, that peak over mu before.
static bool is_after_hold(const char *name)
{
    return strcmp(name, PEAK) == 0 || strcmp(name, HEALING) == 0;
}

static int32_t find_name(const Table *table, const char *name)
{
    for (int32_t k = 0; k < table->csv.columns; k++)
        if (strcmp(table->columns[k].name, name) == 0) return k;
    return -1;
}

// Read at a place of its own: along a series, or after a hold.
static bool is_curve(const Table *table, const char *name)
{
    return is_series(name) || (find_name(table, HOLD) >= 0 && is_after_hold(name));
}

static bool is_result(const Table *table, const char *name)
{
    return is_curve(table, name) || study_record_path(name) != NULL;
}

static bool read_columns(Table *table, Error *err)
{
    const CsvTable *csv = &table->csv;
    int32_t along = 0, results = 0, curves = 0, held = 0;
    if (!(table->columns = NEW_ARRAY(Column, csv->columns, err))) return false;

    // Names and units, each name once.
    for (int32_t k = 0; k < csv->columns; k++) {
        Column *column = &table->columns[k];
        CsvUnit unit;
        int32_t length = 0;
        csv_split(csv, k, &length, &unit);
        if (length >= STUDY_NAME_SIZE)
            return csv_refuse(csv, -1, k, err, "is too long for the name of a column");
        if (unit.length > 0 && !csv_to_si(csv, k, unit, NULL, &column->factor, err)) return false;
        if (unit.length == 0) column->factor = 1;
        snprintf(column->unit, sizeof column->unit, "%.*s", unit.length, unit.text);
        char name[STUDY_NAME_SIZE];
        snprintf(name, sizeof name, "%.*s", length, csv_name(csv, k));
        for (size_t w = 0; w < sizeof WORDED / sizeof *WORDED; w++) {
            int32_t found = -1;
            CsvUnit ignored;
            if (!csv_find(csv, WORDED[w], &found, &ignored, err)) return false;
            if (found == k) snprintf(name, sizeof name, "%s", WORDED[w]);
        }
        int32_t before = find_name(table, name);   // those not read yet are ""
        if (before >= 0 && before < k)
            return csv_refuse(csv, -1, k, err, "is %s a second time, beside column %d", name,
                              before + 1);
        snprintf(column->name, sizeof column->name, "%s", name);
    }

    // The errors of each result, in the result's unit where they have none.
    for (int32_t k = 0; k < csv->columns; k++) table->columns[k].error = -1;
    for (int32_t k = 0; k < csv->columns; k++) {
        Column *column = &table->columns[k];
        CsvUnit unit;
        if (is_key(column->name) || !is_result(table, column->name)) continue;
        csv_find_error(csv, k, &column->error, &unit);
        if (column->error < 0) continue;
        Column *error = &table->columns[column->error];
        if (error->kind == COLUMN_ERROR)
            return csv_refuse(csv, -1, column->error, err,
                              "is the error of one of several results: name each, as in %s_error",
                              column->name);
        error->kind = COLUMN_ERROR;
        if (unit.length == 0) error->factor = column->factor;
    }

    // The kind of each column, and whether all of them make a table.
    for (int32_t k = 0; k < csv->columns; k++) {
        Column *column = &table->columns[k];
        const char *name = column->name;
        if (column->kind == COLUMN_ERROR) continue;
        column->kind = COLUMN_CONDITION;
        if (is_key(name)) continue;
        column->kind = column->error < 0 ? COLUMN_ALONG : COLUMN_RESULT;
        bool is_place = is_series(name) || strcmp(name, HOLD) == 0;
        if (!is_place && !is_result(table, name))
            return csv_refuse(
                csv, -1, k, err,
                "is neither a key of the scene nor a result, as `record` of a study names it, nor "
                "a "
                "series of history.h5, as in series/mu, nor `hold` with `mu` or `healing`");
        if (!is_place && column->error < 0)
            return csv_refuse(csv, -1, k, err,
                              "has no error: a column %s_error has one standard deviation of it",
                              name);
        along += column->kind == COLUMN_ALONG;
        results += column->kind == COLUMN_RESULT;
        curves += column->kind == COLUMN_RESULT && is_curve(table, name);
        held += column->kind == COLUMN_RESULT && is_after_hold(name);
    }
    bool holds = find_name(table, HOLD) >= 0;
    if (results == 0)
        return REFUSE(err, "%s: no column is a result, as in mu_M with mu_M_error", table->path);
    if (along > 1 || (along == 0) != (curves == 0) || (holds && held < curves))
        return REFUSE(
            err,
            "%s: a curve has one column without an error, the series along which it is read, and "
            "at least one with an error: series/rod_displacement, series/mu, series/mu_error; "
            "or hold, mu, mu_error",
            table->path);
    return true;
}

// --- rows ---------------------------------------------------------------------------------------

// "load.pressure: 0.003, mesh.set.length: 1", each value as a scene has it; one that was there
// before is the same. A cell is one plain value: with more in it it would set other keys of the
// scene, too.
static bool find_condition(Measurements *measured, const Table *table, int32_t row, int32_t *found,
                           Error *err)
{
    const CsvTable *csv = &table->csv;
    char *text = NULL, origin[SCENE_TEXT_SIZE];
    size_t size = 0;
    int32_t count = 0, last = 0;
    FILE *out = open_memstream(&text, &size);
    if (!out) FAIL(err, ERROR_MEMORY, "no memory for %s", table->path);
    for (int32_t k = 0; k < csv->columns; k++) {
        const Column *column = &table->columns[k];
        const char *cell = csv_cell(csv, row, k);
        double value = csv_value(csv, row, k);
        bool decimal = csv->decimal_comma && isfinite(value);
        if (column->kind != COLUMN_CONDITION) continue;
        if (!*cell)
            csv_refuse(csv, row, k, err, "is empty: what was it when this was measured?");
        else if (!decimal && strpbrk(cell, ",:{}[]#&*!|>'\"%@`\n"))
            csv_refuse(csv, row, k, err, "`%.40s` is no plain value", cell);
        fprintf(out, "%s%s: ", count++ ? ", " : "", column->name);
        if (decimal)
            fprintf(out, "%.17g", value);
        else
            fputs(cell, out);
        fprintf(out, "%s%s", *column->unit ? " " : "", column->unit);
        last = k;
    }
    if (fclose(out) != 0) FAIL(err, ERROR_MEMORY, "no memory for %s", table->path);
    TRY(error_is_clean(err));
    for (*found = 0; *found < measured->condition_count; ++*found)
        if (strcmp(measured->conditions[*found], text) == 0) goto cleanup;

    // Its origin: "measured.csv:3:1", of the row's only condition; of several "measured.csv:3".
    Error place = {0};
    csv_refuse(csv, row, last, &place, "%s", "");   // it knows where a cell begins
    const char *end = strstr(place.message, ": ");
    if (count == 1 && end && end > place.message)
        snprintf(origin, sizeof origin, "%.*s", (int)(end - place.message), place.message);
    else
        snprintf(origin, sizeof origin, "%s:%d", table->path, csv->line[row + 1]);
    TRY(memory_grow(&measured->conditions, measured->condition_count, &measured->condition_room,
                    sizeof *measured->conditions, err));
    TRY(memory_resize(&measured->origins, *found, *found + 1, sizeof *measured->origins, err));
    TRY(measured->conditions[*found] = memory_text(text, err));
    measured->condition_count++;
    TRY(measured->origins[*found] = memory_text(origin, err));
cleanup:
    free(text);
    return error_is_clean(err);
}

static bool read_number(const Table *table, int32_t row, int32_t column, double *value, Error *err)
{
    if (!csv_read_number(&table->csv, row, column, value, err)) return false;
    *value *= table->columns[column].factor;
    return true;
}

static bool read_named(const Study *study, YamlNode node, Measurements *measured, Error *err)
{
    char path[2 * SCENE_TEXT_SIZE];
    const char *given = yaml_text(study->file, node);
    if (yaml_kind(study->file, node) != YAML_SCALAR || !*given || strlen(given) >= SCENE_TEXT_SIZE)
        return yaml_refuse(study->file, node, "measured", "a table's path, or a list of them", err);
    if (!open_check_named(given, err)) {
        error_context(err, "%s: measured", study->path);
        return false;
    }
    folder_beside(study->path, given, path, sizeof path);   // there is room
    Table table = {.path = path};
    TRY(csv_read(path, &table.csv, err));
    TRY(read_columns(&table, err));
    int32_t along = -1;
    for (int32_t k = 0; k < table.csv.columns; k++)
        if (table.columns[k].kind == COLUMN_ALONG) along = k;

    // Rows: a datum for each result that is there.
    const CsvTable *csv = &table.csv;
    for (int32_t row = 0; row < csv->rows; row++) {
        Datum datum = {0};
        TRY(find_condition(measured, &table, row, &datum.condition, err));
        if (along >= 0) TRY(read_number(&table, row, along, &datum.at, err));
        for (int32_t k = 0; k < csv->columns; k++) {
            const char *name = table.columns[k].name;
            int32_t beside = table.columns[k].error;
            if (table.columns[k].kind != COLUMN_RESULT || !*csv_cell(csv, row, k)) continue;
            snprintf(datum.name, sizeof datum.name, "%s", name);
            snprintf(datum.along, sizeof datum.along, "%s",
                     is_curve(&table, name) ? table.columns[along].name : "");
            TRY(read_number(&table, row, k, &datum.value, err));
            TRY(read_number(&table, row, beside, &datum.error, err));
            if (!(datum.error > 0))
                TRY(csv_refuse(csv, row, beside, err, "`%.40s`: an error is above 0",
                               csv_cell(csv, row, beside)));
            if (fabs(datum.value) > LARGEST || datum.error > LARGEST)
                TRY(csv_refuse(csv, row, k, err, "%g with an error of %g; allowed: at most %g",
                               datum.value, datum.error, LARGEST));
            if (datum.error < SMALLEST || datum.error < DIGITS * fabs(datum.value))
                TRY(csv_refuse(csv, row, beside, err,
                               "%g beside %s = %g: nothing is measured to so many digits",
                               datum.error, name, datum.value));
            TRY(memory_grow(&measured->list, measured->count, &measured->room,
                            sizeof *measured->list, err));
            measured->list[measured->count++] = datum;
        }
    }
cleanup:
    memory_free(table.columns);
    csv_destroy(&table.csv);
    return error_is_clean(err);
}

bool measurements_read(const Study *study, Measurements *measured, Error *err)
{
    YamlNode node = study->search.measured;
    char path[2 * SCENE_TEXT_SIZE];
    struct stat seen[2];
    *measured = (Measurements){0};
    if (yaml_kind(study->file, node) != YAML_LIST) return read_named(study, node, measured, err);
    YAML_EACH (one, study->file, node) {
        if (!read_named(study, one, measured, err)) return false;
        YAML_EACH (before, study->file, node) {
            if (before == one) break;

            // Both name one file, by whatever path.
            folder_beside(study->path, yaml_text(study->file, before), path, sizeof path);
            if (stat(path, &seen[0]) != 0) continue;
            folder_beside(study->path, yaml_text(study->file, one), path, sizeof path);
            if (stat(path, &seen[1]) == 0 && seen[0].st_dev == seen[1].st_dev &&
                seen[0].st_ino == seen[1].st_ino)
                return yaml_refuse(study->file, one, "measured", "each table once", err);
        }
    }
    return error_is_clean(err);
}

void measurements_destroy(Measurements *measured)
{
    for (int32_t k = 0; k < measured->condition_count; k++)
        memory_free_all(measured->conditions[k], measured->origins[k]);
    memory_free_all(measured->conditions, measured->origins, measured->list);
    *measured = (Measurements){0};
}

// --- what a run came to -------------------------------------------------------------------------

bool measurements_curve(const Datum *datum, const char *history, double **x, double **y,
                        int64_t *count, Error *err)
{
    int64_t other = 0;
    int32_t width = 0;
    Error ignored = {0};   // it is only read
    ArrayFile *file = NULL;
    if (access(history, R_OK) != 0)
        FAIL(err, ERROR_INPUT,
             "%s is read from the history of a run, which none was kept of: say `set: "
             "{output.history: true}` and `keep: points`",
             datum->name);
    TRY(file = array_file_open(history, err));
    TRY(array_file_read(file, datum->along, x, count, &width, err));
    if (width == 1) TRY(array_file_read(file, datum->name, y, &other, &width, err));
    if (width != 1 || *count != other)
        FAIL(err, ERROR_INPUT, "%s over %s: a series has one number a step", datum->name,
             datum->along);
cleanup:
    array_file_close(file, &ignored);
    return error_is_clean(err);
}

bool measurements_find(const Datum *datum, const char *report, const char *history, double *value,
                       double *error, Error *err)
{
    *value = NAN;
    *error = 0;
    if (!report) return true;
    if (strcmp(datum->along, HOLD) == 0) {
        // Interpolates mu or its rise after a hold of this duration between the run's own holds,
        // linearly in the logarithm of the time held. NaN: no holds are as short or as long.

        // ln(duration / at), value and error of two holds: the longest that is not longer than
        // `at`, and the shortest that is longer.
        double before[3] = {NAN, NAN, NAN};
        double behind[3] = {NAN, NAN, NAN};
        for (int32_t k = 0;; k++) {
            double found[4];
            static const char *const names[] = {"duration", "healing", "healing_error",
                                                "mu_before"};
            for (int32_t n = 0; n < 4; n++) {
                char path[STUDY_NAME_SIZE];
                snprintf(path, sizeof path, "results.program.holds.%d.%s", k, names[n]);
                if (!json_find_number(report, path, &found[n])) found[n] = n == 0 ? -1 : NAN;
            }
            if (found[0] < 0) break;
            if (isnan(found[1])) continue;
            double at = log(found[0] / datum->at);
            if (strcmp(datum->name, PEAK) == 0) found[1] += found[3];
            double *side = at <= DIGITS ? before : behind;
            if (at > DIGITS ? !(at > behind[0]) : !(at < before[0]))
                memcpy(side, (double[]){at, found[1], found[2]}, sizeof before);
        }
        if (fabs(before[0]) <= DIGITS) memcpy(behind, before, sizeof before);
        double width = behind[0] - before[0], part = width > 0 ? -before[0] / width : 0;
        *value = before[1] + part * (behind[1] - before[1]);
        *error = fmax(before[2], behind[2]) / 2;
        if (isnan(*error)) *error = 0;
        return true;
    }
    if (*datum->along) {
        // The value of y where x first reaches `at` from either side, linear between steps; NaN: x
        // does not reach it.
        double *x = NULL, *y = NULL;
        int64_t rows = 0;
        bool read = measurements_curve(datum, history, &x, &y, &rows, err);
        for (int64_t k = 1; read && k < rows; k++) {
            double part = (datum->at - x[k - 1]) / (x[k] - x[k - 1]);
            if (!(part >= 0 && part <= 1)) continue;
            *value = y[k - 1] + part * (y[k] - y[k - 1]);
            break;
        }
        memory_free_all(x, y);
        return read;
    }
    PointValue found = point_value(report, study_record_path(datum->name));
    *value = found.value;
    if (isfinite(found.known_to)) *error = found.known_to / 2;
    return true;
}
