// SPDX-License-Identifier: GPL-2.0-or-later
// A study's points in the order of one result. A gain is value / baseline - 1. Two points whose
// bounds of mu_M (of mu_hold, ranked by that) overlap are not distinguished by these runs: such a
// point is marked as good as the best.
#include "study/sweep/rank.h"

#include "base/memory.h"
#include "io/csv_writer.h"
#include "io/json_reader.h"
#include "study/sweep/study_point.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CELL_SIZE = 80, NOTE_SIZE = 120, CELLS_MAX = STUDY_COLUMNS_MAX + 6 };

// --- order --------------------------------------------------------------------------------------

static const StudyRecord *ranked_by(const Study *study)
{
    return &study->records[study->rank.record];
}

// Descending; rows without a value come last, equal ones in the study's order.
static int compare(const void *left, const void *right)
{
    const RankRow *a = left, *b = right;
    if (isnan(a->value) != isnan(b->value)) return isnan(a->value) ? 1 : -1;
    if (a->value != b->value && !isnan(a->value)) return a->value < b->value ? 1 : -1;
    return a->point - b->point;
}

// NaN where there is none, or where it failed.
static double baseline_value(const Sweep *sweep, const double *values, const Ranking *ranking,
                             int32_t point)
{
    int32_t base = 0;
    if (sweep->study.rank.against == AGAINST_BEST) base = ranking->rows[0].point;
    if (sweep->study.rank.against == AGAINST_KEYS) base = sweep->points[point].baseline;
    return base >= 0 ? values[base] : NAN;
}

// `lowest` is sorted as `highest` of the negative values, which are turned back afterwards.
bool ranking_make(const Sweep *sweep, const SweepTable *table, Ranking *ranking, Error *err)
{
    const Study *study = &sweep->study;
    double sign = study->rank.lowest ? -1 : 1;
    const double *values = &table->records[(int64_t)study->rank.record * study->point_count];
    *ranking = (Ranking){.count = study->point_count};
    const Bounds *bounds = table_bounds(table, ranked_by(study), &ranking->bounded);
    TRY((ranking->rows = NEW_ARRAY(RankRow, study->point_count, err)));
    for (int32_t k = 0; k < ranking->count; k++) {
        ranking->rows[k] = (RankRow){.point = k,
                                     .value = sign * values[k],
                                     .low = NAN,
                                     .high = NAN,
                                     .period = bounds->period[k]};
        if (isnan(values[k])) continue;
        ranking->ranked++;
        if (!ranking->bounded) continue;
        ranking->rows[k].low = bounds->low[k];
        ranking->rows[k].high = bounds->high[k];
    }
    qsort(ranking->rows, (size_t)ranking->count, sizeof *ranking->rows, compare);
    const RankRow *best = &ranking->rows[0];
    ranking->base = study->rank.against == AGAINST_KEYS ? (double)NAN
                                                        : baseline_value(sweep, values, ranking, 0);
    for (int32_t k = 0; k < ranking->count; k++) {
        RankRow *row = &ranking->rows[k];
        row->value *= sign;
        row->gain = row->value / baseline_value(sweep, values, ranking, row->point) - 1;
        row->as_good = k > 0 && row->low <= best->high && row->high >= best->low;
    }
cleanup:
    return error_is_clean(err);
}

// Zeroed is fine.
void ranking_destroy(Ranking *ranking)
{
    memory_free(ranking->rows);
    *ranking = (Ranking){0};
}

// --- notes --------------------------------------------------------------------------------------

static void add_note(char note[NOTE_SIZE], const char *words)
{
    size_t used = strlen(note);
    snprintf(note + used, NOTE_SIZE - used, "%s%s", used ? ", " : "", words);
}

// What makes a value doubtful, and the sentence in which the run itself warned ("": none).
static bool row_notes(const Sweep *sweep, const RankRow *row, char note[NOTE_SIZE],
                      char warning[RUN_WARNING_SIZE], Error *err)
{
    PointStatus status = sweep->points[row->point].status;
    char *report = status == POINT_DONE ? point_report(sweep, row->point, err) : NULL;
    double enough = 1;
    *note = *warning = 0;
    TRY(error_is_clean(err));
    if (status != POINT_DONE) add_note(note, point_status_name(status));
    if (status == POINT_DONE && isnan(row->value)) add_note(note, "no value");
    if (row->period == 0) add_note(note, "not periodic");
    if (report && strcmp(ranked_by(&sweep->study)->path, "results.mu_hold") == 0 &&
        json_find_number(report, "results.drops.enough", &enough) && enough == 0)
        add_note(note, "too few drops");
    if (row->period > 1) add_note(note, "by turns");
    if (row->as_good) add_note(note, "as good as the first");
    if (report && json_find_text(report, "warnings.0", warning, RUN_WARNING_SIZE))
        add_note(note, "warned");
cleanup:
    memory_free(report);
    return error_is_clean(err);
}

// --- ranking.csv --------------------------------------------------------------------------------

static void write_head(CsvWriter *csv, const Study *study)
{
    csv_text(csv, "rank");
    csv_text(csv, "point");
    for (int32_t k = 0; k < study->column_count; k++) csv_text(csv, study->columns[k]);
    csv_text(csv, ranked_by(study)->name);
    csv_text(csv, "low");
    csv_text(csv, "high");
    csv_text(csv, "gain_percent");
    csv_text(csv, "note");
    csv_text(csv, "warning");
    csv_end_row(csv);
}

// The rank of a point without a value is empty; its note gives the reason.
static bool write_row(CsvWriter *csv, const Sweep *sweep, const Ranking *ranking, int32_t k,
                      Error *err)
{
    const RankRow *row = &ranking->rows[k];
    const Study *study = &sweep->study;
    char cell[SCENE_TEXT_SIZE], note[NOTE_SIZE], warning[RUN_WARNING_SIZE];
    double ignored = 0;
    Scene *scene = NEW_ARRAY(Scene, 1, err);
    TRY(scene);
    TRY(study_point_scene(study, row->point, scene, err));
    TRY(row_notes(sweep, row, note, warning, err));
    csv_number(csv, isnan(row->value) ? (double)NAN : k + 1);
    csv_number(csv, row->point);
    for (int32_t c = 0; c < study->column_count; c++) {
        study_scene_value(scene, study->columns[c], cell, sizeof cell, &ignored);
        csv_text(csv, cell);
    }
    csv_number(csv, row->value);
    csv_number(csv, row->low);
    csv_number(csv, row->high);
    csv_number(csv, 100 * row->gain);
    csv_text(csv, note);
    csv_text(csv, warning);
    csv_end_row(csv);
cleanup:
    memory_free(scene);
    return error_is_clean(err);
}

// All points, also those that a terminal does not show.
bool ranking_write(const Sweep *sweep, const Ranking *ranking, Error *err)
{
    char path[POINT_PATH_SIZE];
    CsvWriter *csv = NULL;
    snprintf(path, sizeof path, "%s/ranking.csv", sweep->folder);
    TRY((csv = csv_create(path, err)));
    write_head(csv, &sweep->study);
    for (int32_t k = 0; k < ranking->count; k++) TRY(write_row(csv, sweep, ranking, k, err));
cleanup:
    if (error_is_clean(err)) return csv_finish(csv, err);
    csv_abandon(csv);
    return false;
}

// --- on the terminal ----------------------------------------------------------------------------

// A line of the printed table: rank, the keys chosen, value, low, high, gain, note.
typedef struct PrintedRow {
    char cells[CELLS_MAX][CELL_SIZE];
    char note[NOTE_SIZE];
} PrintedRow;

static char *add_cell(PrintedRow *row, int32_t *count)
{
    return row->cells[(*count)++];
}

static void add_number(PrintedRow *row, int32_t *count, const char *format, double value)
{
    char *cell = add_cell(row, count);
    if (isfinite(value)) snprintf(cell, CELL_SIZE, format, value);
}

// Row 0 is the head. *count: cells in a row.
static void print_head(const Study *study, bool bounded, PrintedRow *row, int32_t *count)
{
    *count = 0;
    snprintf(add_cell(row, count), CELL_SIZE, "rank");
    for (int32_t k = 0; k < study->column_count; k++)
        if (study_is_chosen(study, study->columns[k]))
            snprintf(add_cell(row, count), CELL_SIZE, "%.79s", study->columns[k]);
    snprintf(add_cell(row, count), CELL_SIZE, "%.79s", ranked_by(study)->name);
    if (bounded) {
        snprintf(add_cell(row, count), CELL_SIZE, "low");
        snprintf(add_cell(row, count), CELL_SIZE, "high");
    }
    snprintf(add_cell(row, count), CELL_SIZE, "gain");
}

// Key columns that follow from formulas are left out: they tell no point from another.
static bool print_row(const Sweep *sweep, const Ranking *ranking, int32_t k, PrintedRow *row,
                      Error *err)
{
    const RankRow *from = &ranking->rows[k];
    const Study *study = &sweep->study;
    char warning[RUN_WARNING_SIZE];
    int32_t count = 0;
    double ignored = 0;
    Scene *scene = NEW_ARRAY(Scene, 1, err);
    TRY(scene);
    TRY(study_point_scene(study, from->point, scene, err));
    add_number(row, &count, "%.0f", k + 1);
    for (int32_t c = 0; c < study->column_count; c++)
        if (study_is_chosen(study, study->columns[c]))
            study_scene_value(scene, study->columns[c], add_cell(row, &count), CELL_SIZE, &ignored);
    add_number(row, &count, "%.4g", from->value);
    if (ranking->bounded) {
        add_number(row, &count, "%.4g", from->low);
        add_number(row, &count, "%.4g", from->high);
    }
    add_number(row, &count, "%+.1f %%", 100 * from->gain);
    TRY(row_notes(sweep, from, row->note, warning, err));
cleanup:
    memory_free(scene);
    return error_is_clean(err);
}

// "mu_M, highest first; gain over the first point (mesh.set.n=1)"
static bool print_title(const Sweep *sweep, FILE *out, Error *err)
{
    const Study *study = &sweep->study;
    char words[POINT_WORDS_SIZE] = "";
    Scene *scene = NEW_ARRAY(Scene, 1, err);
    TRY(scene);
    TRY(study_point_scene(study, 0, scene, err));
    fprintf(out, "\n%s, %s first; gain over ", ranked_by(study)->name,
            study->rank.lowest ? "lowest" : "highest");
    if (study->rank.against == AGAINST_BEST) fprintf(out, "the best");
    if (study->rank.against == AGAINST_FIRST) {
        point_words(sweep, scene, words);
        fprintf(out, "the first point (%s)", words);
    }
    if (study->rank.against == AGAINST_KEYS) {
        fprintf(out, "the same point with");
        for (YamlNode item = yaml_first(study->file, study->rank.baseline); item != YAML_NO_NODE;
             item = yaml_next(study->file, item))
            fprintf(out, " %s=%s", yaml_key(study->file, item), yaml_text(study->file, item));
    }
    fprintf(out, "\n");
cleanup:
    memory_free(scene);
    return error_is_clean(err);
}

// rows: [shown + 1] with the head; every cell but the note to the right of its column.
static void print_rows(const PrintedRow *rows, int32_t shown, int32_t cells, FILE *out)
{
    for (int32_t k = 0; k <= shown; k++) {
        for (int32_t c = 0; c < cells; c++) {
            int widest = 0;
            for (int32_t i = 0; i <= shown; i++) {
                int width = (int)strlen(rows[i].cells[c]);
                if (width > widest) widest = width;
            }
            fprintf(out, "  %*s", widest, rows[k].cells[c]);
        }
        fprintf(out, "%s%s\n", rows[k].note[0] ? "  " : "", rows[k].note);
    }
}

// Nothing is printed where the caller wants nothing (options->out NULL).
bool ranking_print(const Sweep *sweep, const Ranking *ranking, Error *err)
{
    FILE *out = sweep->options->out;
    int32_t cells = 0, shown = ranking->ranked;
    PrintedRow *rows = NULL;
    if (!out) return true;
    if (shown > sweep->study.rank.top) shown = sweep->study.rank.top;
    TRY((rows = NEW_ARRAY(PrintedRow, shown + 1, err)));
    print_head(&sweep->study, ranking->bounded, &rows[0], &cells);
    for (int32_t k = 0; k < shown; k++) TRY(print_row(sweep, ranking, k, &rows[k + 1], err));
    TRY(print_title(sweep, out, err));
    print_rows(rows, shown, cells, out);
    if (ranking->count > shown)
        fprintf(out, "  ... %d more in ranking.csv\n", ranking->count - shown);
    if (ranking->count > ranking->ranked)
        fprintf(out, "  %d of %d have no value\n", ranking->count - ranking->ranked,
                ranking->count);
cleanup:
    memory_free(rows);
    return error_is_clean(err);
}
