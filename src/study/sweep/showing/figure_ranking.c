// SPDX-License-Identifier: GPL-2.0-or-later
// A row a point. Bars: the errors of the table, none where the error is not known. Open marks:
// points whose runs warned.
#include "study/sweep/showing/figure_ranking.h"

#include "study/sweep/reading/study.h"
#include "study/sweep/showing/figure_file.h"

#include <math.h>
#include <string.h>

enum { NAME_SIZE = 60, ROWS_MAX = 60, BASELINE_COLOR = 7 };

static const double ROW_HEIGHT = 0.05, HEIGHT_LEFT = 0.17;   // of the width: a row; axis and name

static void join(char *text, size_t size, const char *word)
{
    size_t used = strlen(text);
    snprintf(text + used, size - used, "%s%.50s", used ? ", " : "", word);
}

// Doubts about a row, as bits.
static int32_t doubts_of(const SweepTable *table, const Ranking *ranking, int32_t k)
{
    const RankRow *row = &ranking->rows[k];
    return (table->doubtful->values[row->point] > 0 ? DOUBT_WARNED : 0) |
           (ranking->has_error && isnan(row->error) ? DOUBT_NO_ERROR : 0);
}

// Nothing is drawn where no point has a value.
bool figure_of_ranking(const Sweep *sweep, const SweepTable *table, const Ranking *ranking,
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
    QuantityLabel label = label_of_record(study->records[study->rank.record].name);
    TRY(figure_begin(&figure, err));
    JsonWriter *json = figure.json;
    json_number(json, "height", fmax(0.3, HEIGHT_LEFT + ROW_HEIGHT * shown));
    figure_write_axis(&figure, "x", &label, "linear");

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
            join(words, sizeof words, label_of_key(study->columns[c], false).words);
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
