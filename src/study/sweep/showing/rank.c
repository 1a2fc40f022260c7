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
#include "io/text/json_reader.h"
#include "study/sweep/reading/study.h"
#include "run/result/figure_file.h"
#include "study/sweep/showing/quantity_label.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CELL_SIZE = 80, CELLS_MAX = STUDY_COLUMNS_MAX + 6, RANK_NOTE_SIZE = 120 };
enum { NAME_SIZE = 60, ROWS_MAX = 60, BASELINE_COLOR = 7 };   // of the figure

static const double ROW_HEIGHT = 0.05, HEIGHT_LEFT = 0.17;   // of the width: a row; axis and name

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

static bool is_decided(double value, double error, const RankRow *row)
{
    double difference = value - row->value;
    return difference * difference > error * error + row->error * row->error;
}

// rows: sorted. The ranks that each may have. Rows further off than one that even the largest of
// all errors decides are decided wherever their own error is known: squares and sums are rounded
// alike for all.
static void find_places(Ranking *ranking)
{
    int32_t count = ranking->ranked, unknown = 0, unknown_before = 0;
    RankRow *rows = ranking->rows;
    double largest = 0;
    for (int32_t k = 0; k < count; k++) {
        unknown += isnan(rows[k].error);
        largest = fmax(largest, rows[k].error);
    }
    for (int32_t k = 0; k < count; k++) {
        RankRow *row = &rows[k];
        row->from = 1;
        row->to = count;
        if (isnan(row->error)) {
            unknown_before++;
            continue;
        }

        // As if all rows with a known error were decided; then those near it that are not.
        row->from = k + 1 - unknown_before;
        row->to = k + 1 + unknown - unknown_before;
        for (int32_t i = k; i-- > 0 && !is_decided(rows[i].value, largest, row);)
            row->from -= !isnan(rows[i].error) && !is_decided(rows[i].value, rows[i].error, row);
        for (int32_t i = k + 1; i < count && !is_decided(rows[i].value, largest, row); i++)
            row->to += !isnan(rows[i].error) && !is_decided(rows[i].value, rows[i].error, row);
    }
}

// `lowest` is sorted as `highest` of the negative values, which are turned back afterwards.
bool ranking_make(const Sweep *sweep, const SweepTable *table, Ranking *ranking, Error *err)
{
    const Study *study = &sweep->study;
    int32_t record = study->rank.record;
    double sign = study->rank.lowest ? -1 : 1;
    *ranking = (Ranking){.count = study->point_count, .has_error = table->error[record] >= 0};
    if (!(ranking->rows = NEW_ARRAY(RankRow, study->point_count, err))) return false;
    for (int32_t k = 0; k < ranking->count; k++) {
        double error = table_error(table, record, k);
        double known_to = table_known_to(table, record, k);
        ranking->rows[k] = (RankRow){.point = k,
                                     .value = sign * table_value(table, record, k),
                                     .error = known_to,
                                     .bar = error == known_to ? error : (double)NAN};
        ranking->ranked += !isnan(ranking->rows[k].value);
    }
    qsort(ranking->rows, (size_t)ranking->count, sizeof *ranking->rows, compare);
    if (ranking->has_error) find_places(ranking);
    int32_t base = study->rank.against == AGAINST_KEYS ? -1 : baseline_of(sweep, ranking, 0);
    ranking->base = base < 0 ? (double)NAN : table_value(table, record, base);
    for (int32_t k = 0; k < ranking->count; k++) {
        RankRow *row = &ranking->rows[k];
        row->value *= sign;
        row->gain = row->gain_error = NAN;
        base = baseline_of(sweep, ranking, row->point);
        if (base < 0) continue;
        double value = table_value(table, record, base);
        double error = table_known_to(table, record, base);
        bool itself = sweep->points[base].same_as == sweep->points[row->point].same_as;
        row->gain = row->value / value - 1;
        row->gain_error = itself ? 0 * row->error
                                 : hypot(row->error / value, row->value / value * error / value);
    }
    return true;
}

// Zeroed is fine.
void ranking_destroy(Ranking *ranking)
{
    memory_free(ranking->rows);
    *ranking = (Ranking){0};
}

// --- notes --------------------------------------------------------------------------------------

static void join(char *text, size_t size, const char *word)
{
    size_t used = strlen(text);
    snprintf(text + used, size - used, "%s%.50s", used ? ", " : "", word);
}

// Says in a few words what makes a value or its rank doubtful.
static bool rank_notes(const Sweep *sweep, const Ranking *ranking, const RankRow *row,
                       char note[RANK_NOTE_SIZE], Error *err)
{
    PointStatus status = sweep->points[row->point].status;
    char *report = status == POINT_DONE ? point_report(sweep, row->point, err) : NULL;
    char text[60], warning[8];
    double enough = 1, over = 1, period = NAN;   // of the values behind the result; NaN: not known
    bool by_mu_hold = strcmp(ranked_by(&sweep->study)->path, "results.mu_hold") == 0;
    *note = 0;
    TRY(error_is_clean(err));
    if (report)
        json_find_number(report, by_mu_hold ? "results.drops.period" : "results.period", &period);
    if (status != POINT_DONE) join(note, RANK_NOTE_SIZE, point_status_name(status));
    if (status == POINT_DONE && isnan(row->value)) join(note, RANK_NOTE_SIZE, "no value");
    snprintf(text, sizeof text, "not decided between %d and %d", row->from, row->to);
    if (row->from < row->to) join(note, RANK_NOTE_SIZE, text);
    if (ranking->has_error && !isnan(row->value) && isnan(row->error))
        join(note, RANK_NOTE_SIZE, "error not known");
    if (period == 0) join(note, RANK_NOTE_SIZE, "not periodic");
    if (report && by_mu_hold && json_find_number(report, "results.drops.enough", &enough) &&
        enough == 0)
        join(note, RANK_NOTE_SIZE, "too few drops");
    if (report && json_find_number(report, "results.run_in.over", &over) && over == 0)
        join(note, RANK_NOTE_SIZE, "run-in not over");
    snprintf(text, sizeof text, "period %.0f", period);
    if (period > 1) join(note, RANK_NOTE_SIZE, text);
    if (report && json_find_text(report, "warnings.0", warning, sizeof warning))
        join(note, RANK_NOTE_SIZE, "warned");
cleanup:
    memory_free(report);
    return error_is_clean(err);
}

// --- ranking.csv --------------------------------------------------------------------------------

// All points, also those that a terminal does not show. The rank of a point without a value is
// empty; its note gives the reason.
static bool write_ranking(const Sweep *sweep, const SweepTable *table, const Ranking *ranking,
                          Error *err)
{
    const Study *study = &sweep->study;
    const char *name = ranked_by(study)->name;
    char path[POINT_PATH_SIZE], cell[SCENE_TEXT_SIZE], note[RANK_NOTE_SIZE];
    char error[STUDY_NAME_SIZE + 16], known_to[STUDY_NAME_SIZE + 16];
    TextWriter *csv = NULL;
    snprintf(path, sizeof path, "%s/ranking.csv", sweep->folder);
    snprintf(error, sizeof error, "%s_error", name);
    snprintf(known_to, sizeof known_to, "%s_known_to", name);
    TRY((csv = text_writer_create(path, false, err)));
    csv_text(csv, "rank");
    csv_text(csv, "rank_from");
    csv_text(csv, "rank_to");
    csv_text(csv, "point");
    for (int32_t k = 0; k < study->column_count; k++) csv_text(csv, study->columns[k]);
    csv_text(csv, name);
    csv_text(csv, error);
    csv_text(csv, known_to);
    csv_text(csv, "gain_percent");
    csv_text(csv, "gain_percent_error");
    csv_text(csv, "note");
    csv_text(csv, "warnings");
    csv_end_row(csv);

    for (int32_t k = 0; k < ranking->count; k++) {
        const RankRow *row = &ranking->rows[k];
        double ignored = 0;
        const Scene *scene = point_scene(sweep, row->point, err);
        TRY(scene);
        TRY(rank_notes(sweep, ranking, row, note, err));
        csv_number(csv, isnan(row->value) ? (double)NAN : (double)k + 1);
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
    }
cleanup:
    return text_writer_finish(csv, err);
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

static bool print_ranking(const Sweep *sweep, const SweepTable *table, const Ranking *ranking,
                          FILE *out, Error *err)
{
    int32_t cells = 0, shown = ranking->ranked;
    PrintedRow *rows = NULL;
    if (shown > sweep->study.rank.top) shown = sweep->study.rank.top;
    TRY((rows = NEW_ARRAY(PrintedRow, shown + 1, err)));

    // Row 0 is the head; each row has `cells` cells.
    const Study *study = &sweep->study;
    PrintedRow *row = &rows[0];
    snprintf(add_cell(row, &cells), CELL_SIZE, "rank");
    for (int32_t k = 0; k < study->column_count; k++)
        if (study->chosen[k])
            snprintf(add_cell(row, &cells), CELL_SIZE, "%.79s", study->columns[k]);
    snprintf(add_cell(row, &cells), CELL_SIZE, "%.79s", ranked_by(study)->name);
    snprintf(add_cell(row, &cells), CELL_SIZE, "gain");

    // Key columns that follow from formulas are left out: they tell no point from another.
    for (int32_t k = 0; k < shown; k++) {
        const RankRow *from = &ranking->rows[k];
        int32_t count = 0;
        double ignored = 0;
        const Scene *scene = point_scene(sweep, from->point, err);
        TRY(scene);
        row = &rows[k + 1];
        snprintf(add_cell(row, &count), CELL_SIZE, "%d", k + 1);
        for (int32_t c = 0; c < study->column_count; c++)
            if (study->chosen[c])
                study_scene_value(scene, study->columns[c], add_cell(row, &count), CELL_SIZE,
                                  &ignored);
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
    }

    // "mu_M, highest first; gain over the first point (mesh.set.n=1)"
    char words[POINT_WORDS_SIZE] = "";
    const Scene *first = point_scene(sweep, 0, err);
    TRY(first);
    fprintf(out, "\n%s, %s first; gain over ", ranked_by(study)->name,
            study->rank.lowest ? "lowest" : "highest");
    if (study->rank.against == AGAINST_BEST) fprintf(out, "the best");
    if (study->rank.against == AGAINST_FIRST) {
        point_words(sweep, first, words);
        fprintf(out, "the first point (%s)", words);
    }
    if (study->rank.against == AGAINST_KEYS) {
        fprintf(out, "the same point with");
        YAML_EACH (item, study->file, study->rank.baseline)
            fprintf(out, " %s=%s", yaml_key(study->file, item), yaml_text(study->file, item));
    }
    fprintf(out, "%s\n", ranking->has_error ? "" : "; no errors are known of it");

    // Every cell but the note stands to the right of its column.
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
    if (ranking->count > shown)
        fprintf(out, "  ... %d more in ranking.csv\n", ranking->count - shown);
    if (ranking->ranked > 0) print_edges(sweep, table, ranking, out);
cleanup:
    memory_free(rows);
    return error_is_clean(err);
}

// --- the figure ---------------------------------------------------------------------------------

// Doubts about a row, as bits.
static int32_t doubts_of(const SweepTable *table, const Ranking *ranking, int32_t k)
{
    const RankRow *row = &ranking->rows[k];
    return (table->doubtful->values[row->point] > 0 ? DOUBT_WARNED : 0) |
           (ranking->has_error && isnan(row->error) ? DOUBT_NO_ERROR : 0);
}

// A row a point, none where no point has a value. Bars: the errors of the table, none where the
// error is not known. Open marks: points whose runs warned.
static bool draw_ranking(const Sweep *sweep, const SweepTable *table, const Ranking *ranking,
                         Error *err)
{
    const Study *study = &sweep->study;
    Figure figure = {.folder = sweep->folder, .name = "ranking", .title = study->title};
    double x[ROWS_MAX], y[ROWS_MAX], error[ROWS_MAX], ignored = 0;
    char words[QUANTITY_LABEL_SIZE] = "", cell[SCENE_TEXT_SIZE];
    int32_t found = 0;
    int32_t shown = ranking->ranked;
    if (shown > study->rank.top) shown = study->rank.top;
    if (shown > ROWS_MAX) shown = ROWS_MAX;
    if (shown == 0) return true;
    QuantityLabel label = quantity_label(study->records[study->rank.record].name, false);
    TRY(figure_begin(&figure, err));
    JsonWriter *json = figure.json;
    json_number(json, "height", fmax(0.3, HEIGHT_LEFT + ROW_HEIGHT * shown));
    figure_write_axis(&figure, "x", label.words, label.unit, label.column, "linear");

    // Names: the values of the keys chosen, from the lowest row of the figure upwards.
    json_begin_object(json, "y");
    json_begin_list(json, "names");
    for (int32_t k = shown - 1; k >= 0; k--) {
        char name[NAME_SIZE] = "";
        const Scene *scene = point_scene(sweep, ranking->rows[k].point, err);
        TRY(scene);
        for (int32_t c = 0; c < study->column_count; c++) {
            if (!study->chosen[c]) continue;
            study_scene_value(scene, study->columns[c], cell, sizeof cell, &ignored);
            join(name, sizeof name, cell);
        }
        json_text(json, NULL, name);
    }
    json_end(json);
    for (int32_t c = 0; c < study->column_count; c++)
        if (study->chosen[c])
            join(words, sizeof words, quantity_label(study->columns[c], false).words);
    json_text(json, "label", words);
    json_end(json);

    // An upright line at what gains are measured from, where that is one value.
    json_begin_list(json, "series");
    double base = ranking->base, base_x[] = {base, base}, base_y[] = {0.5, shown + 0.5};
    Curve line = {.label = "what gains are measured from",
                  .line = "dashed",
                  .color = BASELINE_COLOR,
                  .count = 2,
                  .x = base_x,
                  .y = base_y};
    if (!isnan(base)) TRY(figure_write_curve(&figure, &line, err));

    // Marks and bars of all rows, and over them open marks of those whose runs warned.
    for (int32_t k = 0; k < shown; k++) {
        x[k] = ranking->rows[k].value;
        y[k] = shown - k;
        error[k] = ranking->rows[k].error;
        found |= doubts_of(table, ranking, k);
    }
    Curve marks = {.label = "",
                   .line = "none",
                   .marker = "circle",
                   .color = 1,
                   .count = shown,
                   .filled = true,
                   .x = x,
                   .y = y,
                   .error = error,
                   .lying = true};
    TRY(figure_write_curve(&figure, &marks, err));
    for (int32_t k = 0; k < shown; k++)
        if (!(doubts_of(table, ranking, k) & DOUBT_WARNED)) x[k] = NAN;
    marks.filled = false;
    marks.error = NULL;
    if (found) TRY(figure_write_curve(&figure, &marks, err));
    TRY(figure_write_doubts(&figure, found, false, err));
    json_end(json);
cleanup:
    return figure_end(&figure, err);
}

// --- the whole ----------------------------------------------------------------------------------

bool ranking_show(const Sweep *sweep, const SweepTable *table, FILE *out, bool whole, Error *err)
{
    Ranking ranking = {0};
    TRY(ranking_make(sweep, table, &ranking, err));
    TRY(write_ranking(sweep, table, &ranking, err));
    if (whole && out) TRY(print_ranking(sweep, table, &ranking, out, err));
    if (whole) TRY(draw_ranking(sweep, table, &ranking, err));
cleanup:
    ranking_destroy(&ranking);
    return error_is_clean(err);
}
