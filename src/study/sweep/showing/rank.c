// SPDX-License-Identifier: GPL-2.0-or-later
// A study's points in the order of one result. The order of two points is decided where their
// values differ by more than both errors, taken as independent: |a - b| > sqrt(e_a^2 + e_b^2). A
// point's rank lies between one more than the points that are decidedly better and the number of
// those that are not decidedly worse. An error that is not known decides nothing; where there is no
// error bar it is what a mesh usually leaves (answers/error_bars).
//
// A gain is g = a / b - 1 over the baseline b; to first order its error is that of a / b,
// sqrt((e_a / b)^2 + (a e_b / b^2)^2), and 0 for the baseline itself.
#include "study/sweep/showing/rank.h"

#include "base/memory.h"
#include "base/text.h"
#include "io/text/csv_writer.h"
#include "study/sweep/reading/study_point.h"
#include "study/sweep/showing/rank_notes.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CELL_SIZE = 80, CELLS_MAX = STUDY_COLUMNS_MAX + 6 };

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

// -1: there is none.
static int32_t baseline_of(const Sweep *sweep, const Ranking *ranking, int32_t point)
{
    if (sweep->study.rank.against == AGAINST_BEST) return ranking->rows[0].point;
    return sweep->study.rank.against == AGAINST_KEYS ? sweep->points[point].baseline : 0;
}

static bool is_decided(const RankRow *a, const RankRow *b)
{
    double difference = a->value - b->value;
    return difference * difference > a->error * a->error + b->error * b->error;
}

static bool is_beyond(double value, double largest_error, const RankRow *row)
{
    return is_decided(&(RankRow){.value = value, .error = largest_error}, row);
}

// rows: sorted. The ranks that each may have. A row that even the largest error of those further
// off decides is decided wherever its own error is known, and so are they: squares and sums are
// rounded alike for all.
static bool find_places(Ranking *ranking, Error *err)
{
    int32_t count = ranking->ranked;
    RankRow *rows = ranking->rows;
    int32_t *known = NEW_ARRAY(int32_t, count + 1, err);   // errors of the rows before
    double *low = NEW_ARRAY(double, count + 1, err);   // largest error of the rows before
    double *high = NEW_ARRAY(double, count + 1, err);   // of this row and those behind
    for (int32_t k = 0; error_is_clean(err) && k < count; k++) {
        known[k + 1] = known[k] + !isnan(rows[k].error);
        low[k + 1] = fmax(low[k], rows[k].error);
    }
    for (int32_t k = count; error_is_clean(err) && k-- > 0;)
        high[k] = fmax(high[k + 1], rows[k].error);
    for (int32_t k = 0; error_is_clean(err) && k < count; k++) {
        RankRow *row = &rows[k];
        int32_t before = k, after = k + 1;
        row->from = 1;
        row->to = count;
        if (isnan(row->error)) continue;
        for (; before > 0 && !is_beyond(rows[before - 1].value, low[before], row); before--)
            row->from += is_decided(&rows[before - 1], row);
        for (; after < count && !is_beyond(rows[after].value, high[after], row); after++)
            row->to -= is_decided(&rows[after], row);
        row->from += known[before];
        row->to -= known[count] - known[after];
    }
    memory_free_all(known, low, high);
    return error_is_clean(err);
}

// How far each is known, beside those that were refined.
static RankRow row_of(const Sweep *sweep, const SweepTable *table, const Ranking *ranking,
                      int32_t point)
{
    int32_t record = sweep->study.rank.record;
    double error = table_error(table, record, point);
    double known_to = table_known_to(table, record, point);
    double times = sweep->points[point].refined ? 1 : fmax(ranking->moved, 1);
    return (RankRow){.point = point,
                     .value = table_value(table, record, point),
                     .error = times * known_to,
                     .bar = error == known_to ? error : (double)NAN};
}

static void find_gain(const Sweep *sweep, const SweepTable *table, const Ranking *ranking,
                      RankRow *row)
{
    int32_t base = baseline_of(sweep, ranking, row->point), record = sweep->study.rank.record;
    row->gain = row->gain_error = NAN;
    if (base < 0) return;
    double value = table_value(table, record, base);
    double error = row_of(sweep, table, ranking, base).error;
    bool itself = sweep->points[base].same_as == sweep->points[row->point].same_as;
    row->gain = row->value / value - 1;
    row->gain_error = itself ? 0 * row->error
                             : hypot(row->error / value, row->value / value * error / value);
}

// `lowest` is sorted as `highest` of the negative values, which are turned back afterwards.
bool ranking_make(const Sweep *sweep, const SweepTable *table, Ranking *ranking, Error *err)
{
    const Study *study = &sweep->study;
    double sign = study->rank.lowest ? -1 : 1;
    *ranking =
        (Ranking){.count = study->point_count, .has_error = table->error[study->rank.record] >= 0};
    if (!(ranking->rows = NEW_ARRAY(RankRow, study->point_count, err))) return false;
    for (int32_t k = 0; k < ranking->count; k++) {
        const SweepPoint *point = &sweep->points[k];
        if (!point->refined || point->same_as != k) continue;
        ranking->refined++;
        ranking->moved = fmax(ranking->moved, point->moved);
    }
    for (int32_t k = 0; k < ranking->count; k++) {
        ranking->rows[k] = row_of(sweep, table, ranking, k);
        ranking->rows[k].value *= sign;
        ranking->ranked += !isnan(ranking->rows[k].value);
    }
    qsort(ranking->rows, (size_t)ranking->count, sizeof *ranking->rows, compare);
    if (ranking->has_error && !find_places(ranking, err)) return false;
    int32_t base = study->rank.against == AGAINST_KEYS ? -1 : baseline_of(sweep, ranking, 0);
    ranking->base = base < 0 ? (double)NAN : table_value(table, study->rank.record, base);
    for (int32_t k = 0; k < ranking->count; k++) {
        ranking->rows[k].value *= sign;
        find_gain(sweep, table, ranking, &ranking->rows[k]);
    }
    return true;
}

// Zeroed is fine.
void ranking_destroy(Ranking *ranking)
{
    memory_free(ranking->rows);
    *ranking = (Ranking){0};
}

// --- ranking.csv --------------------------------------------------------------------------------

static void write_head(CsvWriter *csv, const Study *study)
{
    char error[STUDY_NAME_SIZE + 16], known_to[STUDY_NAME_SIZE + 16];
    snprintf(error, sizeof error, "%s_error", ranked_by(study)->name);
    snprintf(known_to, sizeof known_to, "%s_known_to", ranked_by(study)->name);
    csv_text(csv, "rank");
    csv_text(csv, "rank_from");
    csv_text(csv, "rank_to");
    csv_text(csv, "point");
    for (int32_t k = 0; k < study->column_count; k++) csv_text(csv, study->columns[k]);
    csv_text(csv, ranked_by(study)->name);
    csv_text(csv, error);
    csv_text(csv, known_to);
    csv_text(csv, "gain_percent");
    csv_text(csv, "gain_percent_error");
    csv_text(csv, "note");
    csv_text(csv, "warnings");
    csv_end_row(csv);
}

// The rank of a point without a value is empty; its note gives the reason.
static bool write_row(CsvWriter *csv, const Sweep *sweep, const SweepTable *table,
                      const Ranking *ranking, const RankRow *row, Error *err)
{
    const Study *study = &sweep->study;
    char cell[SCENE_TEXT_SIZE], note[RANK_NOTE_SIZE];
    double ignored = 0;
    const Scene *scene = point_scene(sweep, row->point, err);
    TRY(scene);
    TRY(rank_notes(sweep, ranking, row, note, err));
    csv_number(csv, isnan(row->value) ? (double)NAN : (double)(row - ranking->rows) + 1);
    csv_number(csv, row->from > 0 ? row->from : (double)NAN);
    csv_number(csv, row->to > 0 ? row->to : (double)NAN);
    csv_number(csv, row->point);
    for (int32_t c = 0; c < study->column_count; c++) {
        study_scene_value(scene, study->columns[c], cell, sizeof cell, &ignored);
        csv_text(csv, cell);
    }
    csv_number(csv, row->value);
    csv_number(csv, table_error(table, study->rank.record, row->point));
    csv_number(csv, row->error);
    csv_number(csv, 100 * row->gain);
    csv_number(csv, 100 * row->gain_error);
    csv_text(csv, note);
    csv_text(csv, table->warnings->words.words[(int32_t)table->warnings->values[row->point]]);
    csv_end_row(csv);
cleanup:
    return error_is_clean(err);
}

// All points, also those that a terminal does not show.
bool ranking_write(const Sweep *sweep, const SweepTable *table, const Ranking *ranking, Error *err)
{
    char path[POINT_PATH_SIZE];
    CsvWriter *csv = NULL;
    snprintf(path, sizeof path, "%s/ranking.csv", sweep->folder);
    TRY((csv = csv_create(path, err)));
    write_head(csv, &sweep->study);
    for (int32_t k = 0; k < ranking->count; k++)
        TRY(write_row(csv, sweep, table, ranking, &ranking->rows[k], err));
cleanup:
    if (error_is_clean(err)) return csv_finish(csv, err);
    csv_abandon(csv);
    return false;
}

// --- on the terminal ----------------------------------------------------------------------------

// A line of the printed table: rank, the keys chosen, value, gain, note.
typedef struct PrintedRow {
    char cells[CELLS_MAX][CELL_SIZE];
    char note[RANK_NOTE_SIZE];
} PrintedRow;

static char *add_cell(PrintedRow *row, int32_t *count)
{
    return row->cells[(*count)++];
}

// Key columns that follow from formulas are left out: they tell no point from another.
static bool print_row(const Sweep *sweep, const Ranking *ranking, int32_t k, PrintedRow *row,
                      Error *err)
{
    const RankRow *from = &ranking->rows[k];
    const Study *study = &sweep->study;
    int32_t count = 0;
    double ignored = 0;
    const Scene *scene = point_scene(sweep, from->point, err);
    TRY(scene);
    snprintf(add_cell(row, &count), CELL_SIZE, "%d", k + 1);
    for (int32_t c = 0; c < study->column_count; c++)
        if (study->chosen[c])
            study_scene_value(scene, study->columns[c], add_cell(row, &count), CELL_SIZE, &ignored);
    text_estimate(from->value, from->bar, ranking->has_error ? from->error : 0,
                  add_cell(row, &count));

    // "+8.1 +- 0.4 %"; without an error bar to the digits that are known, "+8 %". NaN: `?`.
    char *cell = add_cell(row, &count);
    bool has_bar = !isnan(from->bar) && !isnan(from->gain_error);
    double gain = 100 * from->gain, error = 100 * from->gain_error;
    if (isnan(gain))
        snprintf(cell, CELL_SIZE, "?");
    else if (has_bar)
        snprintf(cell, CELL_SIZE, "%+.1f +- %.1f %%", gain, error);
    else
        snprintf(cell, CELL_SIZE, "%+.*f %%", error > 0.1 ? 0 : 1, gain);

    TRY(rank_notes(sweep, ranking, from, row->note, err));
cleanup:
    return error_is_clean(err);
}

// "mu_M, highest first; gain over the first point (mesh.set.n=1)"
static bool print_title(const Sweep *sweep, bool has_error, FILE *out, Error *err)
{
    const Study *study = &sweep->study;
    char words[POINT_WORDS_SIZE] = "";
    const Scene *scene = point_scene(sweep, 0, err);
    TRY(scene);
    fprintf(out, "\n%s, %s first; gain over ", ranked_by(study)->name,
            study->rank.lowest ? "lowest" : "highest");
    if (study->rank.against == AGAINST_BEST) fprintf(out, "the best");
    if (study->rank.against == AGAINST_FIRST) {
        point_words(sweep, scene, words);
        fprintf(out, "the first point (%s)", words);
    }
    if (study->rank.against == AGAINST_KEYS) {
        fprintf(out, "the same point with");
        YAML_EACH (item, study->file, study->rank.baseline)
            fprintf(out, " %s=%s", yaml_key(study->file, item), yaml_text(study->file, item));
    }
    fprintf(out, "%s\n", has_error ? "" : "; no errors are known of it");
cleanup:
    return error_is_clean(err);
}

static void print_refined(const Ranking *ranking, FILE *out)
{
    if (ranking->refined == 0) return;
    fprintf(out,
            "  %d of %d points were computed again with smaller error bars, and moved by up to "
            "%.1f of those before",
            ranking->refined, ranking->ranked, ranking->moved);
    if (ranking->moved > 1 && ranking->refined < ranking->ranked)
        fprintf(out, ": bars of the others count as %.1f times as long in ranks", ranking->moved);
    fprintf(out, "\n");
}

// Keys of which the best point has the least or the largest of three values or more.
static void print_edges(const Sweep *sweep, const SweepTable *table, const Ranking *ranking,
                        FILE *out)
{
    const Study *study = &sweep->study;
    bool found = false;
    for (int32_t c = 0; c < study->column_count; c++) {
        const double *values = table->columns[c].values;
        double ends[2], best = values[ranking->rows[0].point];
        int32_t distinct;
        if (!study->chosen[c] || table->columns[c].words.count > 0) continue;

        // Ends of a key's values; distinct: how many there are, at most three.
        double third = NAN;
        ends[0] = ends[1] = values[0];
        for (int32_t k = 1; k < study->point_count; k++) {
            ends[0] = fmin(ends[0], values[k]);
            ends[1] = fmax(ends[1], values[k]);
        }
        for (int32_t k = 0; k < study->point_count; k++)
            if (values[k] > ends[0] && values[k] < ends[1]) third = values[k];
        distinct = isnan(third) ? 1 + (ends[1] > ends[0]) : 3;

        if (distinct < 3 || (best > ends[0] && best < ends[1])) continue;
        fprintf(out, "%s%s = %.6g",
                found ? ", " : "  The best is at the edge of what was varied: ", study->columns[c],
                best);
        found = true;
    }
    if (found) fprintf(out, "; look beyond\n");
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
bool ranking_print(const Sweep *sweep, const SweepTable *table, const Ranking *ranking, Error *err)
{
    FILE *out = sweep->options->out;
    int32_t cells = 0, shown = ranking->ranked;
    PrintedRow *rows = NULL;
    if (!out) return true;
    if (shown > sweep->study.rank.top) shown = sweep->study.rank.top;
    TRY((rows = NEW_ARRAY(PrintedRow, shown + 1, err)));

    // Row 0 is the head; `cells` in a row.
    const Study *study = &sweep->study;
    PrintedRow *row = &rows[0];
    cells = 0;
    snprintf(add_cell(row, &cells), CELL_SIZE, "rank");
    for (int32_t k = 0; k < study->column_count; k++)
        if (study->chosen[k])
            snprintf(add_cell(row, &cells), CELL_SIZE, "%.79s", study->columns[k]);
    snprintf(add_cell(row, &cells), CELL_SIZE, "%.79s", ranked_by(study)->name);
    snprintf(add_cell(row, &cells), CELL_SIZE, "gain");

    for (int32_t k = 0; k < shown; k++) TRY(print_row(sweep, ranking, k, &rows[k + 1], err));
    TRY(print_title(sweep, ranking->has_error, out, err));
    print_rows(rows, shown, cells, out);
    if (ranking->count > shown)
        fprintf(out, "  ... %d more in ranking.csv\n", ranking->count - shown);
    print_refined(ranking, out);
    if (ranking->ranked > 0) print_edges(sweep, table, ranking, out);
cleanup:
    memory_free(rows);
    return error_is_clean(err);
}
