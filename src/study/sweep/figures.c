// SPDX-License-Identifier: GPL-2.0-or-later
// A sweep's figures. Each is first a description in render/plot_file's format, figures/NAME.json,
// which a user may edit and draw again (`amontons render`); the module `render` makes the picture.
// Open marks: points whose peaks do not repeat.
#include "study/sweep/figures.h"

#include "base/memory.h"
#include "io/folder.h"
#include "io/json_writer.h"
#include "scene/keys.h"
#include "study/sweep/study_point.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { LABEL_SIZE = 90, NAME_SIZE = 60, ROWS_MAX = 60, CURVES_MAX = 15, COLORS = 7 };

static const double ROW_HEIGHT = 0.05, HEIGHT_LEFT = 0.17;   // of the width: a row; axis and name

// --- words --------------------------------------------------------------------------------------

static const char *last_word(const char *key)
{
    const char *dot = strrchr(key, '.');
    return dot ? dot + 1 : key;
}

// The paper's symbol where there is one, with text.h's marks.
static void record_label(const StudyRecord *record, char label[LABEL_SIZE])
{
    static const struct {
        const char *path, *label;
    } known[] = {
        {"results.mu_M", "~{\u03bc}_{M}"},
        {"results.mu_max", "largest ~{\u03bc}"},
        {"results.mu_hold", "~{\u03bc}_{hold}"},
        {"results.peaks.0.mu", "first peak of ~{\u03bc}"},
        {"results.l_c_over_L", "~{l}_{c} / ~{L}"},
        {"results.l_sc_over_L", "~{l}_{sc} / ~{L}"},
    };
    snprintf(label, LABEL_SIZE, "%.80s", record->name);
    for (size_t k = 0; k < sizeof known / sizeof known[0]; k++)
        if (strcmp(record->path, known[k].path) == 0)
            snprintf(label, LABEL_SIZE, "%s", known[k].label);
}

// "pressure (Pa)", or "pressure / E" in normalised units.
static void key_label(const char *name, const Scene *scene, char label[LABEL_SIZE])
{
    static const struct {
        const char *dimension, *si, *normalised;
    } units[] = {{"length", "m", "~{L}_{0}"},
                 {"time", "s", "~{t}_{0}"},
                 {"velocity", "m/s", "(~{L}_{0} / ~{t}_{0})"},
                 {"stress", "Pa", "~{E}"},
                 {"density", "kg/m^{3}", NULL},
                 {"viscosity", "Pa s", NULL}};
    int32_t count = 0, index = scene_key_index(name);
    const SceneKey *keys = scene_keys(&count);
    snprintf(label, LABEL_SIZE, "%.60s", last_word(name));
    if (index < 0 || keys[index].type != KEY_NUMBER) return;
    for (size_t k = 0; k < sizeof units / sizeof units[0]; k++) {
        if (strcmp(keys[index].unit, units[k].dimension) != 0) continue;
        if (scene->units == UNITS_SI)
            snprintf(label, LABEL_SIZE, "%.60s (%s)", last_word(name), units[k].si);
        else if (units[k].normalised)
            snprintf(label, LABEL_SIZE, "%.60s / %s", last_word(name), units[k].normalised);
    }
}

static void join(char *text, size_t size, const char *word)
{
    size_t used = strlen(text);
    snprintf(text + used, size - used, "%s%.50s", used ? ", " : "", word);
}

// --- the description ----------------------------------------------------------------------------

typedef struct Figure {
    const Sweep *sweep;
    const char *name;   // "ranking"
    JsonWriter *json;
    Scene *scene;   // of one point; owned
} Figure;

static void figure_path(const Figure *figure, const char *ending, char path[POINT_PATH_SIZE])
{
    snprintf(path, POINT_PATH_SIZE, "%s/figures/%s.%s", figure->sweep->folder, figure->name,
             ending);
}

// Opens figures/NAME.json, and takes the first point's scene for its units.
static bool begin_figure(Figure *figure, Error *err)
{
    char path[POINT_PATH_SIZE];
    snprintf(path, sizeof path, "%s/figures", figure->sweep->folder);
    TRY(folder_make(path, err));
    TRY((figure->scene = NEW_ARRAY(Scene, 1, err)));
    TRY(study_point_scene(&figure->sweep->study, 0, figure->scene, err));
    figure_path(figure, "json", path);
    TRY((figure->json = json_create(path, err)));
    json_begin_object(figure->json, NULL);
    json_text(figure->json, "title", figure->sweep->study.title);
cleanup:
    return error_is_clean(err);
}

// The description on disk, then its picture. Called once, also after a failure.
static bool end_figure(Figure *figure, Error *err)
{
    char path[POINT_PATH_SIZE], png[POINT_PATH_SIZE];
    JsonWriter *json = figure->json;
    memory_free(figure->scene);
    figure_path(figure, "json", path);
    figure_path(figure, "png", png);
    if (!error_is_clean(err)) {
        json_abandon(json);
        return false;
    }
    json_end(json);
    if (json_finish(json, err)) amontons_render_plot_file(path, png, err);
    return error_is_clean(err);
}

static void write_numbers(JsonWriter *json, const char *key, const double *values, int32_t count)
{
    json_begin_list(json, key);
    for (int32_t k = 0; k < count; k++) json_number(json, NULL, values[k]);
    json_end(json);
}

// Its ends fit the data.
static void write_axis(Figure *figure, const char *name, const char *label, bool is_log)
{
    json_begin_object(figure->json, name);
    json_text(figure->json, "label", label);
    json_text(figure->json, "scale", is_log ? "log" : "linear");
    json_end(figure->json);
}

// One curve of points to draw: [count] each; low NULL: no bars.
typedef struct Curve {
    const char *label, *line;
    int32_t color, count;
    bool marked, filled;
    const double *x, *y, *low, *high;
} Curve;

// Error bars are drawn where `low` is given; `high` is given with it.
static void write_curve(JsonWriter *json, const Curve *curve)
{
    json_begin_object(json, NULL);
    json_text(json, "label", curve->label);
    write_numbers(json, "x", curve->x, curve->count);
    write_numbers(json, "y", curve->y, curve->count);
    if (curve->low) write_numbers(json, "low", curve->low, curve->count);
    if (curve->low) write_numbers(json, "high", curve->high, curve->count);
    json_integer(json, "color", curve->color);
    json_text(json, "marker", curve->marked ? "circle" : "none");
    json_boolean(json, "filled", curve->filled);
    json_text(json, "line", curve->line);
    json_end(json);
}

// --- the ranking --------------------------------------------------------------------------------

// The values of the keys chosen, from the lowest row of the figure upwards.
static bool write_names(Figure *figure, const Ranking *ranking, int32_t shown, Error *err)
{
    const Study *study = &figure->sweep->study;
    char label[LABEL_SIZE] = "", cell[SCENE_TEXT_SIZE];
    double ignored = 0;
    json_begin_object(figure->json, "y");
    json_begin_list(figure->json, "names");
    for (int32_t k = shown - 1; k >= 0; k--) {
        char name[NAME_SIZE] = "";
        TRY(study_point_scene(study, ranking->rows[k].point, figure->scene, err));
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
            join(label, sizeof label, last_word(study->columns[c]));
    json_text(figure->json, "label", label);
    json_end(figure->json);
cleanup:
    return error_is_clean(err);
}

// Marks of the rows that are periodic, or of those that are not; NaN leaves a row out.
static void write_marks(Figure *figure, const Ranking *ranking, int32_t shown, bool periodic)
{
    double x[ROWS_MAX], y[ROWS_MAX], low[ROWS_MAX], high[ROWS_MAX];
    for (int32_t k = 0; k < shown; k++) {
        const RankRow *row = &ranking->rows[k];
        bool is_one = (row->period > 0) == periodic;
        x[k] = is_one ? row->value : NAN;
        y[k] = shown - k;
        low[k] = row->low;
        high[k] = row->high;
    }
    Curve marks = {.label = periodic ? "" : "not periodic",
                   .line = "none",
                   .color = 1,
                   .count = shown,
                   .marked = true,
                   .filled = periodic,
                   .x = x,
                   .y = y,
                   .low = periodic ? low : NULL,   // once for all rows
                   .high = high};
    write_curve(figure->json, &marks);
}

// An upright line at what gains are measured from, where that is one value.
static void write_baseline(Figure *figure, const Ranking *ranking, int32_t shown)
{
    double x[] = {ranking->base, ranking->base}, y[] = {0.5, shown + 0.5};
    if (isnan(ranking->base)) return;
    Curve line = {.label = "", .line = "dashed", .color = COLORS, .count = 2, .x = x, .y = y};
    write_curve(figure->json, &line);
}

// Nothing is drawn where no point has a value.
bool figure_of_ranking(const Sweep *sweep, const Ranking *ranking, Error *err)
{
    Figure figure = {.sweep = sweep, .name = "ranking"};
    char label[LABEL_SIZE];
    int32_t shown = ranking->ranked, open = 0;
    if (shown > sweep->study.rank.top) shown = sweep->study.rank.top;
    if (shown > ROWS_MAX) shown = ROWS_MAX;
    if (shown == 0) return true;
    TRY(begin_figure(&figure, err));
    for (int32_t k = 0; k < shown; k++) open += !(ranking->rows[k].period > 0);
    record_label(&sweep->study.records[sweep->study.rank.record], label);
    json_number(figure.json, "height", fmax(0.3, HEIGHT_LEFT + ROW_HEIGHT * shown));
    write_axis(&figure, "x", label, false);
    TRY(write_names(&figure, ranking, shown, err));
    json_begin_list(figure.json, "series");
    write_baseline(&figure, ranking, shown);
    write_marks(&figure, ranking, shown, true);
    if (open) write_marks(&figure, ranking, shown, false);
    json_end(figure.json);
cleanup:
    return end_figure(&figure, err);
}

// --- the plot of a study ------------------------------------------------------------------------

typedef struct PlotPoint {
    double x, y, low, high;
    bool periodic;
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
    bool bounded = false;
    // A key of the scene has no bounds; whether the point's peaks repeat is still known.
    const Bounds *bounds = study->plot.y.is_record
                               ? table_bounds(table, &study->records[study->plot.y.index], &bounded)
                               : &table->mu_M;
    int32_t count = 0;
    for (int32_t k = 0; k < study->point_count; k++) {
        const double *series = &table->keys[(int64_t)study->plot.series * study->point_count];
        if (study->plot.series >= 0 && series[k] != wanted) continue;
        if (!isfinite(x[k]) || !isfinite(y[k])) continue;
        points[count++] = (PlotPoint){.x = x[k],
                                      .y = y[k],
                                      .low = bounded ? bounds->low[k] : y[k],
                                      .high = bounded ? bounds->high[k] : y[k],
                                      .periodic = bounds->period[k] > 0};
    }
    qsort(points, (size_t)count, sizeof *points, compare_x);
    return count;
}

// A line with marks and bars, and over it open marks where the peaks do not repeat. numbers: room
// for 5 * count.
static void write_points(Figure *figure, const PlotPoint *points, int32_t count, double *numbers,
                         const char *label, int32_t color)
{
    double *x = numbers, *y = x + count, *low = y + count, *high = low + count,
           *open = high + count;
    for (int32_t k = 0; k < count; k++) {
        x[k] = points[k].x;
        y[k] = points[k].y;
        low[k] = points[k].low;
        high[k] = points[k].high;
        open[k] = points[k].periodic ? NAN : y[k];
    }
    Curve curve = {.label = label,
                   .line = "thin",
                   .color = color,
                   .count = count,
                   .marked = true,
                   .filled = true,
                   .x = x,
                   .y = y,
                   .low = low,
                   .high = high};
    write_curve(figure->json, &curve);
    Curve marks = {.label = "",
                   .line = "none",
                   .color = color,
                   .count = count,
                   .marked = true,
                   .x = x,
                   .y = open};
    write_curve(figure->json, &marks);
}

// "length = 0.25", "kind = push"
static void series_label(const Study *study, const SweepTable *table, double value, char *label)
{
    const WordList *words = &table->words[study->plot.series];
    const char *name = last_word(study->columns[study->plot.series]);
    if (words->count > 0)
        snprintf(label, LABEL_SIZE, "%.40s = %.40s", name, words->words[(int32_t)value]);
    else
        snprintf(label, LABEL_SIZE, "%.40s = %.6g", name, value);
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

static void write_axes(Figure *figure)
{
    const Study *study = &figure->sweep->study;
    const StudyPlot *plot = &study->plot;
    char x[LABEL_SIZE], y[LABEL_SIZE];
    if (plot->x.is_record) record_label(&study->records[plot->x.index], x);
    if (!plot->x.is_record) key_label(study->columns[plot->x.index], figure->scene, x);
    if (plot->y.is_record) record_label(&study->records[plot->y.index], y);
    if (!plot->y.is_record) key_label(study->columns[plot->y.index], figure->scene, y);
    write_axis(figure, "x", x, plot->log_x);
    write_axis(figure, "y", y, plot->log_y);
}

// A curve for each value of `series`, in the study's order, whose colours go round after seven.
bool figure_of_plot(const Sweep *sweep, const SweepTable *table, Error *err)
{
    const Study *study = &sweep->study;
    Figure figure = {.sweep = sweep, .name = "plot"};
    double values[CURVES_MAX], *numbers = NULL;
    int32_t curves = 0;
    PlotPoint *points = NEW_ARRAY(PlotPoint, study->point_count, err);
    TRY(points);
    TRY((numbers = NEW_ARRAY(double, 5 * (int64_t)study->point_count, err)));
    TRY(check_axis(study, table, study->plot.x, err));
    TRY(check_axis(study, table, study->plot.y, err));
    TRY(find_curves(study, table, values, &curves, err));
    TRY(begin_figure(&figure, err));
    write_axes(&figure);
    json_begin_list(figure.json, "series");
    for (int32_t k = 0; k < curves; k++) {
        char label[LABEL_SIZE] = "";
        if (study->plot.series >= 0) series_label(study, table, values[k], label);
        int32_t count = gather_points(study, table, values[k], points);
        if (count > 0) write_points(&figure, points, count, numbers, label, 1 + k % COLORS);
    }
    json_end(figure.json);
cleanup:
    memory_free(points);
    memory_free(numbers);
    return end_figure(&figure, err);
}
