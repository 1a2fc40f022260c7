// SPDX-License-Identifier: GPL-2.0-or-later
// The ranking: a row a point. The plot: a curve for each value of a key. Bars: the errors of the
// table. Open marks: points whose runs warned, or whose error is not known; the legend says which.
#include "study/sweep/figures.h"

#include "base/memory.h"
#include "study/sweep/figure_file.h"
#include "study/sweep/study_point.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { NAME_SIZE = 60, ROWS_MAX = 60, CURVES_MAX = 15, COLORS = 7 };

static const double ROW_HEIGHT = 0.05, HEIGHT_LEFT = 0.17;   // of the width: a row; axis and name

static void join(char *text, size_t size, const char *word)
{
    size_t used = strlen(text);
    snprintf(text + used, size - used, "%s%.50s", used ? ", " : "", word);
}

// --- the ranking --------------------------------------------------------------------------------

// The values of the keys chosen, from the lowest row of the figure upwards.
static bool write_names(Figure *figure, const Ranking *ranking, int32_t shown, Error *err)
{
    const Study *study = &figure->sweep->study;
    char label[FIGURE_LABEL_SIZE] = "", cell[SCENE_TEXT_SIZE];
    double ignored = 0;
    json_begin_object(figure->json, "y");
    json_begin_list(figure->json, "names");
    for (int32_t k = shown - 1; k >= 0; k--) {
        char name[NAME_SIZE] = "";
        TRY(point_scene(figure->sweep, ranking->rows[k].point, figure->scene, err));
        for (int32_t c = 0; c < study->column_count; c++) {
            if (!study_is_chosen(study, study->columns[c])) continue;
            study_scene_value(figure->scene, study->columns[c], cell, sizeof cell, &ignored);
            join(name, sizeof name, cell);
        }
        json_text(figure->json, NULL, name);
    }
    json_end(figure->json);
    for (int32_t c = 0; c < study->column_count; c++)
        if (study_is_chosen(study, study->columns[c]))
            join(label, sizeof label, figure_last_word(study->columns[c]));
    json_text(figure->json, "label", label);
    json_end(figure->json);
cleanup:
    return error_is_clean(err);
}

// Marks and bars of all rows, or open marks of those that are doubtful.
static void write_marks(Figure *figure, const SweepTable *table, const Ranking *ranking,
                        int32_t shown, bool open)
{
    double x[ROWS_MAX], y[ROWS_MAX], error[ROWS_MAX];
    for (int32_t k = 0; k < shown; k++) {
        const RankRow *row = &ranking->rows[k];
        uint32_t doubts = figure_doubts(table, row->point, ranking->has_error, row->error);
        x[k] = !open || doubts ? row->value : NAN;
        y[k] = shown - k;
        error[k] = row->error;
    }
    Curve marks = {.label = "",
                   .line = "none",
                   .color = 1,
                   .count = shown,
                   .marked = true,
                   .filled = !open,
                   .x = x,
                   .y = y,
                   .error = open ? NULL : error,
                   .lying = true};
    figure_write_curve(figure->json, &marks);
}

// An upright line at what gains are measured from, where that is one value.
static void write_baseline(Figure *figure, const Ranking *ranking, int32_t shown)
{
    double x[] = {ranking->base, ranking->base}, y[] = {0.5, shown + 0.5};
    if (isnan(ranking->base)) return;
    Curve line = {.label = "", .line = "dashed", .color = COLORS, .count = 2, .x = x, .y = y};
    figure_write_curve(figure->json, &line);
}

// Nothing is drawn where no point has a value.
bool figure_of_ranking(const Sweep *sweep, const SweepTable *table, const Ranking *ranking,
                       Error *err)
{
    Figure figure = {.sweep = sweep, .name = "ranking"};
    int32_t shown = ranking->ranked;
    uint32_t doubts = 0;
    if (shown > sweep->study.rank.top) shown = sweep->study.rank.top;
    if (shown > ROWS_MAX) shown = ROWS_MAX;
    if (shown == 0) return true;
    TRY(figure_begin(&figure, err));
    for (int32_t k = 0; k < shown; k++) {
        const RankRow *row = &ranking->rows[k];
        doubts |= figure_doubts(table, row->point, ranking->has_error, row->error);
    }
    FigureLabel label = figure_record_label(&sweep->study.records[sweep->study.rank.record]);
    json_number(figure.json, "height", fmax(0.3, HEIGHT_LEFT + ROW_HEIGHT * shown));
    figure_write_axis(&figure, "x", &label, false);
    TRY(write_names(&figure, ranking, shown, err));
    json_begin_list(figure.json, "series");
    write_baseline(&figure, ranking, shown);
    write_marks(&figure, table, ranking, shown, false);
    if (doubts) write_marks(&figure, table, ranking, shown, true);
    figure_write_doubts(&figure, &table->warned, doubts);
    json_end(figure.json);
cleanup:
    return figure_end(&figure, err);
}

// --- the plot of a study ------------------------------------------------------------------------

typedef struct PlotPoint {
    double x, y, error;
    uint32_t doubts;   // figure_doubts
} PlotPoint;

static int compare_x(const void *left, const void *right)
{
    double a = ((const PlotPoint *)left)->x, b = ((const PlotPoint *)right)->x;
    return a < b ? -1 : a > b;
}

static const double *axis_values(const Study *study, const SweepTable *table, StudyAxisData axis)
{
    return (axis.is_record ? table->records : table->keys) +
           (int64_t)axis.index * study->point_count;
}

// The points of the curve whose key `series` has the value `wanted`, along x. Returns how many.
static int32_t gather_points(const Study *study, const SweepTable *table, double wanted,
                             PlotPoint *points)
{
    const double *x = axis_values(study, table, study->plot.x);
    const double *y = axis_values(study, table, study->plot.y);
    int32_t record = study->plot.y.is_record ? study->plot.y.index : 0;
    const double *errors = table->errors + (int64_t)record * study->point_count;
    bool has_error = study->plot.y.is_record && table->has_error[record];
    int32_t count = 0;
    for (int32_t k = 0; k < study->point_count; k++) {
        const double *series = &table->keys[(int64_t)study->plot.series * study->point_count];
        if (study->plot.series >= 0 && series[k] != wanted) continue;
        if (!isfinite(x[k]) || !isfinite(y[k])) continue;
        double error = has_error ? errors[k] : (double)NAN;
        points[count++] = (PlotPoint){.x = x[k],
                                      .y = y[k],
                                      .error = error,
                                      .doubts = figure_doubts(table, k, has_error, error)};
    }
    qsort(points, (size_t)count, sizeof *points, compare_x);
    return count;
}

// A line with marks and bars, and over it the open marks of points that are doubtful. numbers:
// room for 4 * count. *doubts: theirs are added.
static void write_points(Figure *figure, const PlotPoint *points, int32_t count, double *numbers,
                         Curve curve, uint32_t *doubts)
{
    double *x = numbers, *y = x + count, *error = y + count, *open = error + count;
    uint32_t found = 0;
    for (int32_t k = 0; k < count; k++) {
        x[k] = points[k].x;
        y[k] = points[k].y;
        error[k] = points[k].error;
        open[k] = points[k].doubts ? y[k] : NAN;
        found |= points[k].doubts;
    }
    curve.count = count;
    curve.line = "thin";
    curve.marked = curve.filled = true;
    curve.x = x;
    curve.y = y;
    curve.error = error;
    figure_write_curve(figure->json, &curve);
    *doubts |= found;
    if (!found) return;
    curve.label = "";
    curve.line = "none";
    curve.filled = false;
    curve.y = open;
    curve.error = NULL;
    figure_write_curve(figure->json, &curve);
}

// "length = 0.25", "kind = push"
static void series_label(const Study *study, const SweepTable *table, double value, char *label)
{
    const WordList *words = &table->words[study->plot.series];
    const char *name = figure_last_word(study->columns[study->plot.series]);
    if (words->count > 0)
        snprintf(label, FIGURE_LABEL_SIZE, "%.40s = %.40s", name, words->words[(int32_t)value]);
    else
        snprintf(label, FIGURE_LABEL_SIZE, "%.40s = %.6g", name, value);
}

// The values of the key `series`, in the order of the study. ERROR_INPUT: too many.
static bool find_curves(const Study *study, const SweepTable *table, double values[CURVES_MAX],
                        int32_t *count, Error *err)
{
    *count = 1;
    values[0] = 0;
    if (study->plot.series < 0) return true;
    const double *series = &table->keys[(int64_t)study->plot.series * study->point_count];
    *count = 0;
    for (int32_t k = 0; k < study->point_count; k++) {
        int32_t at = 0;
        while (at < *count && values[at] != series[k]) at++;
        if (at < *count) continue;
        if (*count == CURVES_MAX)
            FAIL(err, ERROR_INPUT, "plot: series: %s has more than %d values: too many curves",
                 study->columns[study->plot.series], CURVES_MAX);
        values[(*count)++] = series[k];
    }
cleanup:
    return error_is_clean(err);
}

// ERROR_INPUT: the values are words, which no axis can show.
static bool check_axis(const Study *study, const SweepTable *table, StudyAxisData axis, Error *err)
{
    if (!axis.is_record && table->words[axis.index].count > 0)
        FAIL(err, ERROR_INPUT, "plot: %s has words, not numbers: it can be the `series`",
             study->columns[axis.index]);
cleanup:
    return error_is_clean(err);
}

static FigureLabel axis_label(const Figure *figure, StudyAxisData axis)
{
    const Study *study = &figure->sweep->study;
    return axis.is_record ? figure_record_label(&study->records[axis.index])
                          : figure_key_label(study->columns[axis.index], figure->scene);
}

static void write_axes(Figure *figure)
{
    const StudyPlot *plot = &figure->sweep->study.plot;
    FigureLabel x = axis_label(figure, plot->x), y = axis_label(figure, plot->y);
    figure_write_axis(figure, "x", &x, plot->log_x);
    figure_write_axis(figure, "y", &y, plot->log_y);
}

// A curve for each value of `series`, in the study's order, whose colours go round after seven.
bool figure_of_plot(const Sweep *sweep, const SweepTable *table, Error *err)
{
    const Study *study = &sweep->study;
    Figure figure = {.sweep = sweep, .name = "plot"};
    double values[CURVES_MAX], *numbers = NULL;
    int32_t curves = 0;
    uint32_t doubts = 0;
    PlotPoint *points = NEW_ARRAY(PlotPoint, study->point_count, err);
    TRY(points);
    TRY((numbers = NEW_ARRAY(double, 4 * (int64_t)study->point_count, err)));
    TRY(check_axis(study, table, study->plot.x, err));
    TRY(check_axis(study, table, study->plot.y, err));
    TRY(find_curves(study, table, values, &curves, err));
    TRY(figure_begin(&figure, err));
    write_axes(&figure);
    json_begin_list(figure.json, "series");
    for (int32_t k = 0; k < curves; k++) {
        char label[FIGURE_LABEL_SIZE] = "";
        if (study->plot.series >= 0) series_label(study, table, values[k], label);
        int32_t count = gather_points(study, table, values[k], points);
        Curve curve = {.label = label, .color = 1 + k % COLORS};
        if (count > 0) write_points(&figure, points, count, numbers, curve, &doubts);
    }
    figure_write_doubts(&figure, &table->warned, doubts);
    json_end(figure.json);
cleanup:
    memory_free(points);
    memory_free(numbers);
    return figure_end(&figure, err);
}
