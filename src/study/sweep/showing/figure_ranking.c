// SPDX-License-Identifier: GPL-2.0-or-later
// A row a point. Bars: the errors of the table. Open marks: points whose runs warned, or whose
// error is not known; the legend says which.
#include "study/sweep/showing/figure_ranking.h"

#include "study/sweep/reading/study_point.h"
#include "study/sweep/showing/figure_file.h"

#include <math.h>
#include <string.h>

enum { NAME_SIZE = 60, ROWS_MAX = 60, BASELINE_COLOR = 7 };

static const double ROW_HEIGHT = 0.05, HEIGHT_LEFT = 0.17;   // of the width: a row; axis and name

typedef struct RankingFigure {
    Figure figure;
    const Sweep *sweep;
    const Ranking *ranking;
    const SweepTable *table;
    int32_t shown;   // rows
} RankingFigure;

static void join(char *text, size_t size, const char *word)
{
    size_t used = strlen(text);
    snprintf(text + used, size - used, "%s%.50s", used ? ", " : "", word);
}

// The values of the keys chosen, from the lowest row of the figure upwards.
static bool write_names(RankingFigure *self, Error *err)
{
    const Study *study = &self->sweep->study;
    JsonWriter *json = self->figure.json;
    char label[QUANTITY_LABEL_SIZE] = "", cell[SCENE_TEXT_SIZE];
    double ignored = 0;
    json_begin_object(json, "y");
    json_begin_list(json, "names");
    for (int32_t k = self->shown - 1; k >= 0; k--) {
        char name[NAME_SIZE] = "";
        const Scene *scene = point_scene(self->sweep, self->ranking->rows[k].point, err);
        if (!scene) return false;
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
            join(label, sizeof label, label_of_key(study->columns[c], false).words);
    json_text(json, "label", label);
    json_end(json);
    return true;
}

// Why the mark of a row is open, as bits.
static uint32_t doubts_of(const RankingFigure *self, int32_t k)
{
    const RankRow *row = &self->ranking->rows[k];
    uint32_t warned = (uint32_t)self->table->kinds->values[row->point];
    return warned | (self->ranking->has_error && isnan(row->error) ? DOUBT_NO_ERROR : 0);
}

// Marks and bars of all rows, or open marks of those that are doubtful.
static bool write_marks(RankingFigure *self, bool open, Error *err)
{
    double x[ROWS_MAX], y[ROWS_MAX], error[ROWS_MAX];
    for (int32_t k = 0; k < self->shown; k++) {
        const RankRow *row = &self->ranking->rows[k];
        bool warned = doubts_of(self, k) & ~DOUBT_NO_ERROR;
        x[k] = !open || warned ? row->value : NAN;
        y[k] = self->shown - k;
        error[k] = row->error;
    }
    Curve marks = {.label = "",
                   .line = "none",
                   .marker = "circle",
                   .color = 1,
                   .count = self->shown,
                   .filled = !open,
                   .x = x,
                   .y = y,
                   .error = open ? NULL : error,
                   .lying = true};
    return figure_write_curve(&self->figure, &marks, err);
}

// An upright line at what gains are measured from, where that is one value.
static bool write_baseline(RankingFigure *self, Error *err)
{
    double base = self->ranking->base, x[] = {base, base}, y[] = {0.5, self->shown + 0.5};
    if (isnan(base)) return true;
    Curve line = {.label = "what gains are measured from",
                  .line = "dashed",
                  .color = BASELINE_COLOR,
                  .count = 2,
                  .x = x,
                  .y = y};
    return figure_write_curve(&self->figure, &line, err);
}

static bool write_figure(RankingFigure *self, Error *err)
{
    const Study *study = &self->sweep->study;
    uint32_t found = 0;
    for (int32_t k = 0; k < self->shown; k++) found |= doubts_of(self, k);
    QuantityLabel label = label_of_record(study->records[study->rank.record].name);
    if (!figure_begin(&self->figure, err)) return false;
    JsonWriter *json = self->figure.json;
    json_number(json, "height", fmax(0.3, HEIGHT_LEFT + ROW_HEIGHT * self->shown));
    figure_write_axis(&self->figure, "x", &label, "linear");
    if (!write_names(self, err)) return false;
    json_begin_list(json, "series");
    if (!write_baseline(self, err)) return false;
    if (!write_marks(self, false, err)) return false;
    if (found && !write_marks(self, true, err)) return false;
    if (!figure_write_doubts(&self->figure, &self->table->kinds->words, found, false, err))
        return false;
    json_end(json);
    return true;
}

// Nothing is drawn where no point has a value.
bool figure_of_ranking(const Sweep *sweep, const SweepTable *table, const Ranking *ranking,
                       Error *err)
{
    RankingFigure self = {
        .figure = {.folder = sweep->folder, .name = "ranking", .title = sweep->study.title},
        .sweep = sweep,
        .table = table,
        .ranking = ranking,
        .shown = ranking->ranked};
    if (self.shown > sweep->study.rank.top) self.shown = sweep->study.rank.top;
    if (self.shown > ROWS_MAX) self.shown = ROWS_MAX;
    if (self.shown == 0) return true;
    write_figure(&self, err);
    return figure_end(&self.figure, err);
}
