// SPDX-License-Identifier: GPL-2.0-or-later
// The table of a sweep, a row a point in the study's order: as text in sweep.csv (RFC 4180), as
// arrays in sweep.h5. Columns: point, the keys that vary, what is recorded, status, message, run.
//
// Both files hold the same rows: the CSV for spreadsheets and readers, the arrays for programs. An
// array has no words: a word is its index in a list that is an attribute beside its column.
#include "study/sweep/table.h"

#include "base/memory.h"
#include "io/array_file.h"
#include "io/csv_writer.h"
#include "io/json_reader.h"
#include "study/sweep/study_point.h"

#include <math.h>
#include <string.h>

enum { CELL_SIZE = 2 * ERROR_MESSAGE_SIZE };

typedef struct TableWriter {
    const Sweep *sweep;
    SweepTable *table;   // filled row by row
    CsvWriter *csv;   // owned, like the next
    char *cell;   // [CELL_SIZE] work
} TableWriter;

// --- sweep.csv ----------------------------------------------------------------------------------

// Names as the study has them: `record` may rename a path.
static void write_head(TableWriter *writer)
{
    const Study *study = &writer->sweep->study;
    csv_text(writer->csv, "point");
    for (int32_t k = 0; k < study->column_count; k++) csv_text(writer->csv, study->columns[k]);
    for (int32_t k = 0; k < study->record_count; k++) csv_text(writer->csv, study->records[k].name);
    csv_text(writer->csv, "status");
    csv_text(writer->csv, "message");
    csv_text(writer->csv, "run");
    csv_end_row(writer->csv);
}

// --- rows ---------------------------------------------------------------------------------------

// NaN where the list is full: such a word is in sweep.csv only.
static double word_index(WordList *list, const char *word)
{
    for (int32_t k = 0; k < list->count; k++)
        if (strcmp(list->words[k], word) == 0) return k;
    if (list->count == WORDS_MAX) return NAN;
    snprintf(list->words[list->count], WORD_SIZE, "%.63s", word);
    return list->count++;
}

// Into a row of the CSV file and a row of the arrays at once.
static void write_keys(TableWriter *writer, int32_t point, const Scene *scene)
{
    const Study *study = &writer->sweep->study;
    for (int32_t k = 0; k < study->column_count; k++) {
        double number = NAN;
        study_scene_value(scene, study->columns[k], writer->cell, CELL_SIZE, &number);
        csv_text(writer->csv, writer->cell);
        if (isnan(number)) number = word_index(&writer->table->words[k], writer->cell);
        writer->table->keys[k * study->point_count + point] = number;
    }
}

// report: of a finished point, or NULL.
static void write_records(TableWriter *writer, int32_t point, const char *report)
{
    const Study *study = &writer->sweep->study;
    for (int32_t k = 0; k < study->record_count; k++) {
        const char *path = study->records[k].path;
        double number = NAN;
        if (report && !json_find_number(report, path, &number) &&
            json_find_text(report, path, writer->cell, CELL_SIZE))
            csv_text(writer->csv, writer->cell);
        else
            csv_number(writer->csv, number);
        writer->table->records[k * study->point_count + point] = number;
    }
}

// Without a report, or one of a failed point, nothing is known.
static void clear_bounds(Bounds *bounds, int32_t point)
{
    bounds->low[point] = bounds->high[point] = bounds->period[point] = NAN;
}

// Two standard errors to either side of `result`; run.json has the error beside it.
static void note_bounds(Bounds *bounds, int32_t point, const char *report, const char *result,
                        const char *period)
{
    char path[STUDY_NAME_SIZE];
    double mu = NAN, error = NAN;
    snprintf(path, sizeof path, "%s_error", result);
    json_find_number(report, period, &bounds->period[point]);
    json_find_number(report, result, &mu);
    json_find_number(report, path, &error);
    bounds->low[point] = mu - 2 * error;
    bounds->high[point] = mu + 2 * error;
}

const Bounds *table_bounds(const SweepTable *table, const StudyRecord *record, bool *bounded)
{
    bool holds = strcmp(record->path, "results.mu_hold") == 0;
    *bounded = holds || strcmp(record->path, "results.mu_M") == 0;
    return holds ? &table->mu_hold : &table->mu_M;
}

// A failed point keeps its keys and its message, and has no results.
static bool write_row(TableWriter *writer, int32_t point, Scene *scene, Error *err)
{
    const Sweep *sweep = writer->sweep;
    const SweepPoint *at = &sweep->points[point];
    char run[HASH_TEXT_SIZE + 8], *report = NULL;
    TRY(study_point_scene(&sweep->study, point, scene, err));
    if (at->status != POINT_PENDING) report = point_report(sweep, point, err);
    TRY(error_is_clean(err));
    csv_number(writer->csv, point);
    write_keys(writer, point, scene);
    // What a failed point came to before it failed is no result.
    write_records(writer, point, at->status == POINT_DONE ? report : NULL);
    clear_bounds(&writer->table->mu_M, point);
    clear_bounds(&writer->table->mu_hold, point);
    if (at->status == POINT_DONE && report) {
        note_bounds(&writer->table->mu_M, point, report, "results.mu_M", "results.period");
        note_bounds(&writer->table->mu_hold, point, report, "results.mu_hold",
                    "results.drops.period");
    }
    csv_text(writer->csv, point_status_name(at->status));
    *writer->cell = 0;
    if (at->status == POINT_FAILED && report)
        json_find_text(report, "message", writer->cell, ERROR_MESSAGE_SIZE);
    csv_text(writer->csv, writer->cell);
    snprintf(run, sizeof run, "points/%s", at->hash);
    csv_text(writer->csv, run);
    csv_end_row(writer->csv);
    writer->table->status[point] = at->status;
cleanup:
    memory_free(report);
    return error_is_clean(err);
}

// --- sweep.h5 -----------------------------------------------------------------------------------

// series: name and description of the column; the rest is the same for all.
static bool write_column(ArrayFile *file, ArraySeries series, const double *values, int32_t count,
                         Error *err)
{
    series.type = ARRAY_FLOAT64;
    series.width = 1;
    series.unit = "of the scene";
    return array_file_add_series(file, &series, err) &&
           array_file_append(file, series.name, values, count, err);
}

// "push|bonded": the word of index k is the k-th.
static bool write_words(ArrayFile *file, const char *column, const WordList *list, Error *err)
{
    char name[STUDY_NAME_SIZE + 16], text[WORDS_MAX * (WORD_SIZE + 2)] = "";
    size_t used = 0;
    if (list->count == 0) return true;
    snprintf(name, sizeof name, "%s words", column);
    for (int32_t k = 0; k < list->count; k++)
        used +=
            (size_t)snprintf(text + used, sizeof text - used, "%s%s", k ? "|" : "", list->words[k]);
    return array_file_set_text(file, name, text, err);
}

// Groups scene/ and result/, a column each, [points].
static bool write_arrays(const Study *study, const SweepTable *table, ArrayFile *file, Error *err)
{
    int32_t count = study->point_count;
    TRY(array_file_set_text(file, "title", study->title, err));
    char name[STUDY_NAME_SIZE + 16];
    for (int32_t k = 0; k < study->column_count; k++) {
        ArraySeries series = {.name = name,
                              .description = "key of the scene; a word is its index "
                                             "in the attribute `KEY words`"};
        snprintf(name, sizeof name, "scene/%s", study->columns[k]);
        TRY(write_column(file, series, &table->keys[k * count], count, err));
        TRY(write_words(file, study->columns[k], &table->words[k], err));
    }
    for (int32_t k = 0; k < study->record_count; k++) {
        ArraySeries series = {.name = name, .description = study->records[k].path};
        snprintf(name, sizeof name, "result/%s", study->records[k].name);
        TRY(write_column(file, series, &table->records[k * count], count, err));
    }
    ArraySeries status = {.name = "result/status", .description = "0 pending, 1 done, 2 failed"};
    TRY(write_column(file, status, table->status, count, err));
cleanup:
    return error_is_clean(err);
}

// Written after sweep.csv: the arrays are filled by its rows.
static bool write_h5(const Sweep *sweep, const SweepTable *table, Error *err)
{
    char path[POINT_PATH_SIZE];
    snprintf(path, sizeof path, "%s/sweep.h5", sweep->folder);
    ArrayFile *file = array_file_create(path, err);
    TRY(file);
    TRY(write_arrays(&sweep->study, table, file, err));
cleanup:
    if (error_is_clean(err)) return array_file_close(file, err);
    array_file_abandon(file);
    return false;
}

static bool make_bounds(int64_t count, Bounds *bounds, Error *err)
{
    TRY((bounds->low = NEW_ARRAY(double, count, err)));
    TRY((bounds->high = NEW_ARRAY(double, count, err)));
    TRY((bounds->period = NEW_ARRAY(double, count, err)));
cleanup:
    return error_is_clean(err);
}

static void destroy_bounds(Bounds *bounds)
{
    memory_free(bounds->low);
    memory_free(bounds->high);
    memory_free(bounds->period);
}

// On failure the table is the caller's to destroy.
static bool make_room(const Study *study, SweepTable *table, Error *err)
{
    int64_t count = study->point_count;
    TRY((table->keys = NEW_ARRAY(double, count * study->column_count, err)));
    TRY((table->records = NEW_ARRAY(double, count * study->record_count, err)));
    TRY((table->status = NEW_ARRAY(double, count, err)));
    TRY(make_bounds(count, &table->mu_M, err));
    TRY(make_bounds(count, &table->mu_hold, err));
    TRY((table->words = NEW_ARRAY(WordList, study->column_count, err)));
cleanup:
    return error_is_clean(err);
}

// Both files get their names when they are complete; an older table is kept until then.
bool table_write(const Sweep *sweep, SweepTable *table, Error *err)
{
    char path[POINT_PATH_SIZE];
    TableWriter writer = {.sweep = sweep, .table = table};
    Scene *scene = NULL;
    *table = (SweepTable){0};
    TRY(make_room(&sweep->study, table, err));
    TRY((scene = NEW_ARRAY(Scene, 1, err)));
    TRY((writer.cell = NEW_ARRAY(char, CELL_SIZE, err)));
    snprintf(path, sizeof path, "%s/sweep.csv", sweep->folder);
    TRY((writer.csv = csv_create(path, err)));
    write_head(&writer);
    for (int32_t k = 0; k < sweep->study.point_count; k++) TRY(write_row(&writer, k, scene, err));
cleanup:
    memory_free(writer.cell);
    memory_free(scene);
    if (error_is_clean(err)) return csv_finish(writer.csv, err) && write_h5(sweep, table, err);
    csv_abandon(writer.csv);
    return false;
}

void table_destroy(SweepTable *table)
{
    memory_free(table->keys);
    memory_free(table->records);
    memory_free(table->status);
    destroy_bounds(&table->mu_M);
    destroy_bounds(&table->mu_hold);
    memory_free(table->words);
    *table = (SweepTable){0};
}
