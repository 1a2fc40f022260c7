// SPDX-License-Identifier: GPL-2.0-or-later
// The table of a sweep, a row a point in the study's order: as text in sweep.csv (RFC 4180), as
// arrays in sweep.h5. Columns: point, the keys that vary, what is recorded, status, message,
// warnings, run.
//
// What run.json holds as NAME_error beside a result NAME is that result's error, whatever the
// result: it becomes the next column, asked for or not. So does NAME_known_to.
//
// Both files hold the same rows: the CSV for spreadsheets and readers, the arrays for programs. An
// array has no words: a word is its index in a list that is an attribute beside its column.
#include "study/sweep/showing/table.h"

#include "base/memory.h"
#include "io/hdf5/array_file.h"
#include "io/text/csv_writer.h"
#include "io/text/json_reader.h"
#include "study/sweep/reading/study_point.h"

#include <math.h>
#include <string.h>

enum { CELL_SIZE = 2 * ERROR_MESSAGE_SIZE, PATH_SIZE = STUDY_NAME_SIZE + 16 };

typedef struct TableWriter {
    const Sweep *sweep;
    SweepTable *table;   // filled row by row
    CsvWriter *csv;   // owned, like the next
    char *cell;   // [CELL_SIZE] work
} TableWriter;

// --- errors -------------------------------------------------------------------------------------

// What stands beside a record: NAME_error, NAME_known_to.
typedef struct Beside {
    const char *ending;
    const bool *has;   // [record_count] run.json has it
    double *values;   // as in the table
    const char *description;
} Beside;

enum { BESIDES = 2 };

static void find_besides(const SweepTable *table, Beside besides[BESIDES])
{
    besides[0] =
        (Beside){"error", table->has_error, table->errors, "error of the column without `_error`"};
    besides[1] = (Beside){"known_to", table->has_known_to, table->known_to,
                          "how far the column without `_known_to` is known"};
}

static void name_beside(const char *name, const Beside *beside, char text[PATH_SIZE])
{
    snprintf(text, PATH_SIZE, "%s_%s", name, beside->ending);
}

// Whether the table gets a column for it: run.json has it, and the study does not record it by
// itself.
static bool is_added(const Study *study, const Beside *beside, int32_t k)
{
    char path[PATH_SIZE];
    name_beside(study->records[k].path, beside, path);
    for (int32_t i = 0; i < study->record_count; i++)
        if (strcmp(study->records[i].path, path) == 0) return false;
    return beside->has[k];
}

// Every run.json of one version has the same keys, so the first that is done tells for all.
static bool find_errors(const Sweep *sweep, SweepTable *table, Error *err)
{
    const Study *study = &sweep->study;
    char *report = NULL, path[PATH_SIZE];
    for (int32_t k = 0; k < study->point_count && !report; k++) {
        if (sweep->points[k].status != POINT_DONE) continue;
        report = point_report(sweep, k, err);
        TRY(error_is_clean(err));
    }
    for (int32_t k = 0; report && k < study->record_count; k++) {
        snprintf(path, sizeof path, "%s_error", study->records[k].path);
        table->has_error[k] = json_may_hold(report, path);
        snprintf(path, sizeof path, "%s_known_to", study->records[k].path);
        table->has_known_to[k] = json_may_hold(report, path);
    }
cleanup:
    memory_free(report);
    return error_is_clean(err);
}

const double *table_values(const Sweep *sweep, const SweepTable *table, int32_t record)
{
    return table->records + (int64_t)record * sweep->study.point_count;
}

const double *table_errors(const Sweep *sweep, const SweepTable *table, int32_t record)
{
    return table->errors + (int64_t)record * sweep->study.point_count;
}

const double *table_known_to(const Sweep *sweep, const SweepTable *table, int32_t record)
{
    const double *known = table->has_known_to[record] ? table->known_to : table->errors;
    return known + (int64_t)record * sweep->study.point_count;
}

// --- sweep.csv ----------------------------------------------------------------------------------

// Names as the study has them: `record` may rename a path.
static void write_head(TableWriter *writer)
{
    const Study *study = &writer->sweep->study;
    csv_text(writer->csv, "point");
    for (int32_t k = 0; k < study->column_count; k++) csv_text(writer->csv, study->columns[k]);
    for (int32_t k = 0; k < study->record_count; k++) {
        Beside besides[BESIDES];
        char name[PATH_SIZE];
        csv_text(writer->csv, study->records[k].name);
        find_besides(writer->table, besides);
        for (int32_t b = 0; b < BESIDES; b++) {
            name_beside(study->records[k].name, &besides[b], name);
            if (is_added(study, &besides[b], k)) csv_text(writer->csv, name);
        }
    }
    csv_text(writer->csv, "status");
    csv_text(writer->csv, "message");
    csv_text(writer->csv, "warnings");
    csv_text(writer->csv, "run");
    csv_end_row(writer->csv);
}

// --- rows ---------------------------------------------------------------------------------------

// Into a row of the CSV file and a row of the arrays at once.
static bool write_keys(TableWriter *writer, int32_t point, const Scene *scene, Error *err)
{
    const Study *study = &writer->sweep->study;
    for (int32_t k = 0; k < study->column_count; k++) {
        double number = NAN;
        study_scene_value(scene, study->columns[k], writer->cell, CELL_SIZE, &number);
        csv_text(writer->csv, writer->cell);
        WordList *words = &writer->table->words[k];
        if (isnan(number) && !words_index(words, writer->cell, &number, err)) return false;
        writer->table->keys[k * study->point_count + point] = number;
    }
    return true;
}

static const char STEADY[] = "steady sliding";   // results.mu_M_is of a block that only creeps

// "no mu_M: the block as a whole did not slide in this run": as run.json says it of mu_M; what else
// a run has not it has not for the same reason.
static void why_missing(const StudyRecord *record, const char *report, char text[RUN_WARNING_SIZE])
{
    char why[RUN_WARNING_SIZE];
    const char *reason = why;
    if (!json_find_text(report, "results.mu_M_is", why, sizeof why)) *why = 0;
    if (strncmp(why, "none: ", 6) == 0)
        reason = why + 6;
    else
        reason = strcmp(why, STEADY) == 0 ? "the block slides steadily, no sliding was fast"
                                          : "this run has none";
    snprintf(text, RUN_WARNING_SIZE, "no %s: %.300s", record->name, reason);
}

static bool is_steady(const char *path, const char *report)
{
    char is[RUN_WARNING_SIZE] = "";
    return strcmp(path, "results.mu_M") == 0 &&
           json_find_text(report, "results.mu_M_is", is, sizeof is) && strcmp(is, STEADY) == 0;
}

// report: of a finished point, or NULL.
static void write_besides(TableWriter *writer, int32_t point, int32_t k, const char *report)
{
    const Study *study = &writer->sweep->study;
    Beside besides[BESIDES];
    char path[PATH_SIZE];
    find_besides(writer->table, besides);
    for (int32_t b = 0; b < BESIDES; b++) {
        double *value = &besides[b].values[k * study->point_count + point];
        name_beside(study->records[k].path, &besides[b], path);
        *value = NAN;
        if (report) json_find_number(report, path, value);
        if (is_added(study, &besides[b], k)) csv_number(writer->csv, *value);
    }
}

// Of a point with a value that may have a bar, and of which more is open than its error says.
static bool lacks_bar(const SweepTable *table, int32_t record, int64_t at)
{
    return table->has_error[record] && isfinite(table->records[at]) &&
           isfinite(table->known_to[at]) && table->known_to[at] != table->errors[at];
}

static void write_records(TableWriter *writer, int32_t point, const char *report)
{
    const Study *study = &writer->sweep->study;
    SweepTable *table = writer->table;
    char text[RUN_WARNING_SIZE];
    bool no_bar = false;
    for (int32_t k = 0; k < study->record_count; k++) {
        const char *path = study->records[k].path;
        double number = NAN;
        int64_t at = (int64_t)k * study->point_count + point;
        bool is_number = !report || json_find_number(report, path, &number);
        if (!is_number && json_find_text(report, path, writer->cell, CELL_SIZE))
            csv_text(writer->csv, writer->cell);
        else
            csv_number(writer->csv, number);
        table->records[at] = number;
        write_besides(writer, point, k, isfinite(number) ? report : NULL);
        no_bar |= lacks_bar(table, k, at);
        if (!report || !study->records[k].is_shown) continue;
        if (!isfinite(number)) {
            why_missing(&study->records[k], report, text);
            warned_add(&table->warned, point, text);
        } else if (is_steady(path, report))
            warned_add(
                &table->warned, point,
                "steady sliding: mu_M is F_T/F_N at which the block slides slowly as a whole");
    }
    table->no_bar += no_bar;
}

// All warnings of a point in one cell, with // between them. report: as above.
static bool write_warnings(TableWriter *writer, int32_t point, const char *report, Error *err)
{
    SweepTable *table = writer->table;
    char path[40], sentence[RUN_WARNING_SIZE];
    size_t used = 0;
    *writer->cell = 0;
    for (int32_t k = 0; report; k++) {
        snprintf(path, sizeof path, "warnings.%d", k);
        if (!json_find_text(report, path, sentence, sizeof sentence)) break;
        warned_add(&table->warned, point, sentence);
        if (used + sizeof sentence + 4 > CELL_SIZE) continue;
        used += (size_t)snprintf(writer->cell + used, CELL_SIZE - used, "%s%s", used ? " // " : "",
                                 sentence);
    }
    csv_text(writer->csv, writer->cell);
    return words_index(&table->warning_words, writer->cell, &table->warnings[point], err);
}

// A failed point keeps its keys and its message, and has no results.
static bool write_row(TableWriter *writer, int32_t point, Error *err)
{
    const Sweep *sweep = writer->sweep;
    const SweepPoint *at = &sweep->points[point];
    char run[HASH_TEXT_SIZE + 8], *report = NULL;
    const char *results = NULL;   // what a failed point came to before it failed is none
    const Scene *scene = point_scene(sweep, point, err);
    TRY(scene);
    if (point == 0) writer->table->is_si = scene->units == UNITS_SI;
    if (at->status != POINT_PENDING) report = point_report(sweep, point, err);
    TRY(error_is_clean(err));
    csv_number(writer->csv, point);
    TRY(write_keys(writer, point, scene, err));
    if (at->status == POINT_DONE) results = report;
    write_records(writer, point, results);
    csv_text(writer->csv, point_status_name(at->status));
    *writer->cell = 0;
    if (at->status == POINT_FAILED && report)
        json_find_text(report, "message", writer->cell, ERROR_MESSAGE_SIZE);
    csv_text(writer->csv, writer->cell);
    TRY(write_warnings(writer, point, results, err));
    snprintf(run, sizeof run, "%s%s", sweep->reports.open ? "" : "points/", at->hash);
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
    return array_file_write(file, &series, values, 0, count, err);
}

// "push|bonded": the word of index k is the k-th.
static bool write_words(ArrayFile *file, const char *column, const WordList *list, Error *err)
{
    char name[STUDY_NAME_SIZE + 16], *text = NULL;
    if (list->count == 0) return true;
    snprintf(name, sizeof name, "%s words", column);
    TRY((text = words_join(list, err)));
    TRY(array_file_set_text(file, name, text, err));
cleanup:
    memory_free(text);
    return error_is_clean(err);
}

// Names of all columns but errors, warnings and status, as plots take them.
static bool write_names(const Study *study, ArrayFile *file, Error *err)
{
    char names[(STUDY_COLUMNS_MAX + STUDY_RECORDS_MAX) * (STUDY_NAME_SIZE + 1)] = "";
    size_t used = 0;
    for (int32_t k = 0; k < study->column_count; k++)
        used += (size_t)snprintf(names + used, sizeof names - used, "%s%s", used ? "|" : "",
                                 study->columns[k]);
    for (int32_t k = 0; k < study->record_count; k++)
        used += (size_t)snprintf(names + used, sizeof names - used, "%s%s", used ? "|" : "",
                                 study->records[k].name);
    return array_file_set_text(file, "columns", names, err);
}

static bool write_warned(const SweepTable *table, int32_t count, ArrayFile *file, Error *err)
{
    ArraySeries series = {.name = "result/warned",
                          .description = "bit k: the run has a warning of the kind that is the "
                                         "k-th in the attribute `warned words`"};
    WordList names = {0};
    double *bits = NEW_ARRAY(double, count, err);
    TRY(bits);
    TRY(warned_bits(&table->warned, &names, bits, err));
    TRY(write_column(file, series, bits, count, err));
    TRY(write_words(file, "warned", &names, err));
cleanup:
    memory_free(bits);
    words_destroy(&names);
    return error_is_clean(err);
}

// Groups scene/ and result/, a column each, [points].
static bool write_arrays(const Study *study, const SweepTable *table, ArrayFile *file, Error *err)
{
    int32_t count = study->point_count;
    if (!array_file_set_text(file, "title", study->title, err)) return false;
    if (!array_file_set_text(file, "units", table->is_si ? "si" : "normalised", err)) return false;
    if (!write_names(study, file, err)) return false;
    char name[STUDY_NAME_SIZE + 16];
    for (int32_t k = 0; k < study->column_count; k++) {
        ArraySeries series = {.name = name,
                              .description = "key of the scene; a word is its index "
                                             "in the attribute `KEY words`"};
        snprintf(name, sizeof name, "scene/%s", study->columns[k]);
        if (!write_column(file, series, &table->keys[k * count], count, err)) return false;
        if (!write_words(file, study->columns[k], &table->words[k], err)) return false;
    }
    for (int32_t k = 0; k < study->record_count; k++) {
        ArraySeries series = {.name = name, .description = study->records[k].path};
        snprintf(name, sizeof name, "result/%s", study->records[k].name);
        if (!write_column(file, series, &table->records[k * count], count, err)) return false;
        Beside besides[BESIDES];
        find_besides(table, besides);
        for (int32_t b = 0; b < BESIDES; b++) {
            if (!is_added(study, &besides[b], k)) continue;
            snprintf(name, sizeof name, "result/%s_%s", study->records[k].name, besides[b].ending);
            series.description = besides[b].description;
            if (!write_column(file, series, &besides[b].values[k * count], count, err))
                return false;
        }
    }
    ArraySeries status = {.name = "result/status", .description = "0 pending, 1 done, 2 failed"};
    if (!write_column(file, status, table->status, count, err)) return false;
    ArraySeries warnings = {.name = "result/warnings",
                            .description = "0 none; else an index in the attribute "
                                           "`warnings words`"};
    return write_column(file, warnings, table->warnings, count, err) &&
           write_words(file, "warnings", &table->warning_words, err) &&
           write_warned(table, count, file, err);
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

// On failure the table is the caller's to destroy.
static bool make_room(const Study *study, SweepTable *table, Error *err)
{
    int64_t count = study->point_count;
    double none = 0;
    if (!(table->keys = NEW_ARRAY(double, count * study->column_count, err))) return false;
    if (!(table->records = NEW_ARRAY(double, count * study->record_count, err))) return false;
    if (!(table->status = NEW_ARRAY(double, count, err))) return false;
    if (!(table->errors = NEW_ARRAY(double, count * study->record_count, err))) return false;
    if (!(table->known_to = NEW_ARRAY(double, count * study->record_count, err))) return false;
    if (!(table->warnings = NEW_ARRAY(double, count, err))) return false;
    table->column_count = study->column_count;
    return (table->words = NEW_ARRAY(WordList, study->column_count, err)) &&
           warned_make(study->point_count, &table->warned, err) &&
           words_index(&table->warning_words, "", &none, err);
}

// Both files get their names when they are complete; an older table is kept until then.
bool table_write(const Sweep *sweep, SweepTable *table, Error *err)
{
    char path[POINT_PATH_SIZE];
    TableWriter writer = {.sweep = sweep, .table = table};
    *table = (SweepTable){0};
    TRY(make_room(&sweep->study, table, err));
    TRY(find_errors(sweep, table, err));
    TRY((writer.cell = NEW_ARRAY(char, CELL_SIZE, err)));
    snprintf(path, sizeof path, "%s/sweep.csv", sweep->folder);
    TRY((writer.csv = csv_create(path, err)));
    write_head(&writer);
    for (int32_t k = 0; k < sweep->study.point_count; k++) TRY(write_row(&writer, k, err));
cleanup:
    memory_free(writer.cell);
    if (error_is_clean(err)) return csv_finish(writer.csv, err) && write_h5(sweep, table, err);
    csv_abandon(writer.csv);
    return false;
}

void table_destroy(SweepTable *table)
{
    memory_free_all(table->keys, table->records, table->errors, table->known_to, table->status,
                    table->warnings);
    for (int32_t k = 0; table->words && k < table->column_count; k++)
        words_destroy(&table->words[k]);
    memory_free(table->words);
    words_destroy(&table->warning_words);
    warned_destroy(&table->warned);
    *table = (SweepTable){0};
}
