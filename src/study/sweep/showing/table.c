// SPDX-License-Identifier: GPL-2.0-or-later
// The table of a sweep, a row a point in the study's order: as text in sweep.csv (RFC 4180), as
// arrays in sweep.h5. Columns: point, the keys that vary, what is recorded, status, message,
// warnings, run.
//
// A number NAME_error beside a result NAME in run.json is that result's error, whatever the result.
// It becomes the next column, whether it is asked for or not. The same holds for NAME_known_to.
//
// Both files hold the same rows: the CSV for spreadsheets and readers, the arrays for programs. An
// array has no words: a word is its index in a list that is an attribute beside its column.
#include "study/sweep/showing/table.h"

#include "base/memory.h"
#include "io/hdf5/array_file.h"
#include "io/text/csv_writer.h"
#include "io/text/json_reader.h"
#include "study/sweep/reading/study.h"

#include <math.h>
#include <string.h>

enum { CELL_SIZE = 2 * ERROR_MESSAGE_SIZE };

typedef struct TableWriter {
    const Sweep *sweep;
    SweepTable *table;   // filled row by row
    TextWriter *csv;   // owned, like the next
    char *cell;   // [CELL_SIZE] work
} TableWriter;

// --- columns ------------------------------------------------------------------------------------

// Columns that may stand beside a result.
static const struct {
    const char *ending, *description;
} BESIDES[] = {{"error", "error of the column without `_error`"},
               {"known_to", "how far the column without `_known_to` is known"}};
enum { BESIDE_COUNT = sizeof BESIDES / sizeof BESIDES[0] };

static void beside(const char *name, int32_t b, char text[TABLE_PATH_SIZE])
{
    snprintf(text, TABLE_PATH_SIZE, "%s_%s", name, BESIDES[b].ending);
}

static TableColumn *add_column(SweepTable *table, const char *group, const char *name,
                               const char *path, const char *description)
{
    TableColumn *column = &table->columns[table->count++];
    *column = (TableColumn){.group = group, .of = -1, .description = description};
    snprintf(column->name, sizeof column->name, "%s", name);
    snprintf(column->path, sizeof column->path, "%s", path);
    return column;
}

// -1: the table has no such column.
static int32_t find_beside(const SweepTable *table, const StudyRecord *record, int32_t b)
{
    char path[TABLE_PATH_SIZE];
    beside(record->path, b, path);
    for (int32_t c = 0; c < table->count; c++)
        if (strcmp(table->columns[c].path, path) == 0) return c;
    return -1;
}

// Every run.json of one version has the same keys, so the first that is done tells for all. On
// failure the table is the caller's to destroy.
static bool make_columns(const Sweep *sweep, SweepTable *table, Error *err)
{
    const Study *study = &sweep->study;
    int32_t most = study->column_count + (1 + BESIDE_COUNT) * study->record_count + 3;
    double none = 0;
    char *report = NULL;
    TRY((table->columns = NEW_ARRAY(TableColumn, most, err)));
    for (int32_t k = 0; k < study->point_count && !report; k++) {
        if (sweep->points[k].status != POINT_DONE) continue;
        report = point_report(sweep, k, err);
        TRY(error_is_clean(err));
    }
    for (int32_t k = 0; k < study->column_count; k++)
        add_column(table, "scene", study->columns[k], "",
                   "key of the scene; a word is its index in the attribute `KEY words`");

    // Each record, and beside it what run.json has beside it, unless that is recorded itself.
    for (int32_t k = 0; k < study->record_count; k++) {
        const StudyRecord *record = &study->records[k];
        char name[TABLE_PATH_SIZE], path[TABLE_PATH_SIZE];
        table->value[k] = table->count;
        add_column(table, "result", record->name, record->path, record->path);
        for (int32_t b = 0; report && b < BESIDE_COUNT; b++) {
            beside(record->name, b, name);
            beside(record->path, b, path);
            bool recorded = false;
            for (int32_t i = 0; i < study->record_count; i++)
                recorded = recorded || strcmp(study->records[i].path, path) == 0;
            if (!recorded && json_may_hold(report, path))
                add_column(table, "result", name, path, BESIDES[b].description)->of =
                    table->value[k];
        }
    }
    for (int32_t k = 0; k < study->record_count; k++) {
        table->error[k] = find_beside(table, &study->records[k], 0);
        table->known_to[k] = find_beside(table, &study->records[k], 1);
    }
    table->status = add_column(table, "result", "status", "", "0 pending, 1 done, 2 failed");
    table->warnings = add_column(table, "result", "warnings", "",
                                 "0 none; else an index in the attribute `warnings words`");
    table->doubtful =
        add_column(table, "result", "warned", "",
                   "1: the run has warnings, or has not what is ranked or drawn; 0: neither");
    for (int32_t c = 0; c < table->count; c++)
        TRY((table->columns[c].values = NEW_ARRAY(double, study->point_count, err)));
    TRY(words_index(&table->warnings->words, "", &none, err));
    TRY(warned_make(study->point_count, &table->warned, err));
cleanup:
    memory_free(report);
    return error_is_clean(err);
}

double table_value(const SweepTable *table, int32_t record, int32_t point)
{
    return table->columns[table->value[record]].values[point];
}

double table_error(const SweepTable *table, int32_t record, int32_t point)
{
    int32_t error = table->error[record];
    return error < 0 ? (double)NAN : table->columns[error].values[point];
}

double table_known_to(const SweepTable *table, int32_t record, int32_t point)
{
    int32_t known_to = table->known_to[record];
    return known_to < 0 ? table_error(table, record, point)
                        : table->columns[known_to].values[point];
}

// --- sweep.csv ----------------------------------------------------------------------------------

static const char STEADY[] = "steady sliding";   // results.mu_M_is of a block that only creeps

// Adds to the warnings where a point lacks the result that is ranked or drawn, or has another one
// in its place, and counts it where it has a value that may have an error bar, and more is open
// than its error says. report: of a point that is done; NULL: it is not.
static void note_missing(SweepTable *table, const Study *study, int32_t point, const char *report)
{
    char text[RUN_WARNING_SIZE], is[RUN_WARNING_SIZE] = "";   // as run.json says it of mu_M
    bool no_bar = false;
    if (report && !json_find_text(report, "results.mu_M_is", is, sizeof is)) *is = 0;
    for (int32_t k = 0; k < study->record_count; k++) {
        const StudyRecord *record = &study->records[k];
        double known_to = table_known_to(table, k, point);
        bool has_value = isfinite(table_value(table, k, point));
        no_bar |= table->error[k] >= 0 && has_value && isfinite(known_to) &&
                  known_to != table_error(table, k, point);
        if (!report || !record->is_shown) continue;
        if (!has_value) {
            // "no mu_M: the block as a whole did not slide in this run": what else a run has not it
            // has not for the same reason.
            const char *reason = "this run has none";
            if (strncmp(is, "none: ", 6) == 0)
                reason = is + 6;
            else if (strcmp(is, STEADY) == 0)
                reason = "the block slides steadily, no sliding was fast";
            snprintf(text, RUN_WARNING_SIZE, "no %s: %.300s", record->name, reason);
            warned_add(&table->warned, point, text);
        } else if (strcmp(record->path, "results.mu_M") == 0 && strcmp(is, STEADY) == 0)
            warned_add(
                &table->warned, point,
                "steady sliding: mu_M is F_T/F_N at which the block slides slowly as a whole");
    }
    table->no_bar += no_bar;
}

// Writes a row of the CSV file, and a row of the arrays at once. A failed point keeps its keys and
// its message, and has no results: what it came to before it failed is none.
static bool write_row(TableWriter *writer, int32_t point, Error *err)
{
    const Sweep *sweep = writer->sweep;
    const Study *study = &sweep->study;
    const SweepPoint *at = &sweep->points[point];
    SweepTable *table = writer->table;
    TextWriter *csv = writer->csv;
    char run[HASH_TEXT_SIZE + 8], path[40], sentence[RUN_WARNING_SIZE], *report = NULL;
    char *cell = writer->cell;
    const Scene *scene = point_scene(sweep, point, err);
    TRY(scene);
    if (point == 0) table->is_si = scene->units == UNITS_SI;
    if (at->status != POINT_PENDING) report = point_report(sweep, point, err);
    TRY(error_is_clean(err));
    const char *results = at->status == POINT_DONE ? report : NULL;

    csv_number(csv, point);
    for (int32_t k = 0; k < study->column_count; k++) {
        TableColumn *column = &table->columns[k];
        double *number = &column->values[point];
        study_scene_value(scene, study->columns[k], cell, CELL_SIZE, number);
        csv_text(csv, cell);
        if (isnan(*number)) TRY(words_index(&column->words, cell, number, err));
    }

    // Results. If one is not finite, the columns beside it are NaN.
    for (TableColumn *column = table->columns + study->column_count; column < table->status;
         column++) {
        bool is_none = column->of >= 0 && !isfinite(table->columns[column->of].values[point]);
        const char *from = is_none ? NULL : results;
        double *number = &column->values[point];
        *number = NAN;
        bool is_number = !from || json_find_number(from, column->path, number);
        if (!is_number && json_find_text(from, column->path, cell, CELL_SIZE))
            csv_text(csv, cell);
        else
            csv_number(csv, *number);
    }
    note_missing(table, study, point, results);
    csv_text(csv, point_status_name(at->status));
    *cell = 0;
    if (at->status == POINT_FAILED && report)
        json_find_text(report, "message", cell, ERROR_MESSAGE_SIZE);
    csv_text(csv, cell);

    // All warnings of the point in one cell, with // between them.
    size_t used = 0;
    *cell = 0;
    for (int32_t k = 0; results; k++) {
        snprintf(path, sizeof path, "warnings.%d", k);
        if (!json_find_text(results, path, sentence, sizeof sentence)) break;
        warned_add(&table->warned, point, sentence);
        if (used + sizeof sentence + 4 > CELL_SIZE) continue;
        used +=
            (size_t)snprintf(cell + used, CELL_SIZE - used, "%s%s", used ? " // " : "", sentence);
    }
    csv_text(csv, cell);
    TRY(words_index(&table->warnings->words, cell, &table->warnings->values[point], err));

    snprintf(run, sizeof run, "%s%s", sweep->reports.open ? "" : "points/", at->hash);
    csv_text(csv, run);
    csv_end_row(csv);
    table->status->values[point] = at->status;
cleanup:
    memory_free(report);
    return error_is_clean(err);
}

// --- sweep.h5 -----------------------------------------------------------------------------------

// Written after sweep.csv: the arrays are filled by its rows. Groups scene/ and result/, a column
// each, [points].
static bool write_h5(const Sweep *sweep, const SweepTable *table, Error *err)
{
    char path[POINT_PATH_SIZE], *words = NULL;
    snprintf(path, sizeof path, "%s/sweep.h5", sweep->folder);
    ArrayFile *file = array_file_create(path, err);
    TRY(file);
    TRY(array_file_set_text(file, "title", sweep->study.title, err));
    TRY(array_file_set_text(file, "units", table->is_si ? "si" : "normalised", err));

    // Names of all columns but errors, warnings and status, as plots take them.
    char names[(STUDY_COLUMNS_MAX + STUDY_RECORDS_MAX) * (STUDY_NAME_SIZE + 1)] = "";
    size_t used = 0;
    for (const TableColumn *column = table->columns; column < table->status; column++)
        if (column->of < 0)
            used += (size_t)snprintf(names + used, sizeof names - used, "%s%s", used ? "|" : "",
                                     column->name);
    TRY(array_file_set_text(file, "columns", names, err));

    // The words of a column are an attribute, "push|bonded": the word of index k is the k-th.
    for (int32_t c = 0; c < table->count; c++) {
        const TableColumn *column = &table->columns[c];
        char name[TABLE_PATH_SIZE + 8];
        ArraySeries series = {.name = name,
                              .type = ARRAY_FLOAT64,
                              .width = 1,
                              .unit = "of the scene",
                              .description = column->description};
        snprintf(name, sizeof name, "%s/%s", column->group, column->name);
        TRY(array_file_write(file, &series, column->values, 0, sweep->study.point_count, err));
        if (column->words.count == 0) continue;
        snprintf(name, sizeof name, "%s words", column->name);
        memory_free(words);
        TRY((words = words_join(&column->words, err)));
        TRY(array_file_set_text(file, name, words, err));
    }
cleanup:
    memory_free(words);
    if (error_is_clean(err)) return array_file_close(file, err);
    array_file_abandon(file);
    return false;
}

// Both files get their names when they are complete; an older table is kept until then.
bool table_write(const Sweep *sweep, SweepTable *table, Error *err)
{
    char path[POINT_PATH_SIZE];
    TableWriter writer = {.sweep = sweep, .table = table};
    *table = (SweepTable){0};
    TRY(make_columns(sweep, table, err));
    TRY((writer.cell = NEW_ARRAY(char, CELL_SIZE, err)));
    snprintf(path, sizeof path, "%s/sweep.csv", sweep->folder);
    TRY((writer.csv = text_writer_create(path, false, err)));

    // Names as the study has them: `record` may rename a path.
    csv_text(writer.csv, "point");
    for (const TableColumn *column = table->columns; column < table->status; column++)
        csv_text(writer.csv, column->name);
    csv_text(writer.csv, "status");
    csv_text(writer.csv, "message");
    csv_text(writer.csv, "warnings");
    csv_text(writer.csv, "run");
    csv_end_row(writer.csv);

    for (int32_t k = 0; k < sweep->study.point_count; k++) TRY(write_row(&writer, k, err));
    for (int32_t k = 0; k < sweep->study.point_count; k++)
        table->doubtful->values[k] = table->warned.of[k] != 0;
cleanup:
    memory_free(writer.cell);
    return text_writer_finish(writer.csv, err) && write_h5(sweep, table, err);
}

void table_destroy(SweepTable *table)
{
    for (int32_t c = 0; c < table->count; c++) {
        words_destroy(&table->columns[c].words);
        memory_free(table->columns[c].values);
    }
    memory_free(table->columns);
    warned_destroy(&table->warned);
    *table = (SweepTable){0};
}
