// SPDX-License-Identifier: GPL-2.0-or-later
// Curves, one for each value of `series`, told apart by colours and marks, or a map. `panels` draws
// each value of a key in a frame of its own. Bars are the errors of the table; open marks are
// points whose runs warned, marks without a bar (of a map: squares) those whose error is not known.
#include "study/sweep/showing/sweep_plot.h"

#include "base/memory.h"
#include "base/order.h"
#include "io/files/folder.h"
#include "io/files/open_file.h"
#include "render/picture_options.h"
#include "run/result/figure_file.h"
#include "study/sweep/reading/study.h"
#include "study/sweep/showing/plot_table.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CURVES_MAX = 15, COLORS = 7, MARKERS = 4 };
enum { VALUES_MAX = 24, GROUP_LABEL_SIZE = 96 };

static const double LOG_SUITS = 0.75;   // scatter of ratios (their logarithms) over that of steps

// The different values of a key, in the order of the points; one without value where none is asked.
typedef struct Values {
    const Quantity *key;   // NULL: all points belong together
    int32_t count;
    double value[VALUES_MAX];
} Values;

typedef struct PlotFigure {
    Figure figure;
    const StudyPlot *plot;
    bool is_map;
    PlotTable table;   // owned, as the next
    Quantity made[PLOT_KEYS];   // of formulas
    const Quantity *quantity[PLOT_KEYS];   // NULL: not asked for
    Values series, panels;
    int32_t found;   // doubts about what is drawn, bits
    bool some_missing;   // points of a map have no value
    double *work;   // [6 * points of the table]; owned
} PlotFigure;

// --- the table ----------------------------------------------------------------------------------

// Lists the different values of a key, which are told apart by curves or panels.
static bool find_values(const PlotFigure *self, PlotKey which, Values *values, Error *err)
{
    const Quantity *key = self->quantity[which];
    *values = (Values){.key = key};
    values->count = key ? 0 : 1;
    for (int32_t k = 0; key && k < self->table.count; k++) {
        int32_t at = 0;
        while (at < values->count && values->value[at] != key->values[k]) at++;
        if (at < values->count || isnan(key->values[k])) continue;
        if (values->count == VALUES_MAX)
            return REFUSE(err, "plot: %s has more than %d values: too many curves or panels",
                          self->plot->text[which], VALUES_MAX);
        values->value[values->count++] = key->values[k];
    }
    return true;
}

// Whether a point has the which-th value.
static bool values_hold(const Values *values, int32_t which, int32_t point)
{
    return !values->key || values->key->values[point] == values->value[which];
}

// "length = 0.25", "kind = push"; empty where there is no key. name: of the key.
static void values_label(const Values *values, int32_t which, const char *name,
                         char label[GROUP_LABEL_SIZE])
{
    const char *word = label_last_word(name);
    label[0] = 0;
    if (!values->key) return;
    if (values->key->words.count > 0)
        snprintf(label, GROUP_LABEL_SIZE, "%.40s = %.40s", word,
                 values->key->words.words[(int32_t)values->value[which]]);
    else {
        // "~{L} / ~{L}_{0} = 0.25", in SI "~{L} = 0.25 m"; without a symbol the last word of the
        // key.
        const QuantityLabel *key = &values->key->label;
        const char *mark = strstr(key->words, "~{");
        if (mark && !strstr(mark, "(of")) word = mark;
        snprintf(label, GROUP_LABEL_SIZE, "%.60s = %.4g%s%s", word, values->value[which],
                 key->unit ? " " : "", key->unit ? key->unit : "");
    }
}

// Reads the quantities of the plot. ERROR_INPUT: a name that the table does not have, words where
// numbers are needed, too many values of a key.
static bool open_table(PlotFigure *self, const char *folder, Error *err)
{
    const StudyPlot *plot = self->plot;
    if (!plot_table_open(folder, &self->table, err)) return false;
    for (PlotKey key = PLOT_X; key < PLOT_KEYS; key++) {
        if (!plot->text[key][0]) continue;
        self->quantity[key] = plot_table_find(&self->table, plot->text[key], &self->made[key], err);
        if (!self->quantity[key]) return false;
        if (key < PLOT_SERIES && self->quantity[key]->words.count > 0)
            return REFUSE(err,
                          "plot: %s has words, not numbers: it can be the `series` or the `panels`",
                          plot->text[key]);
    }
    if (!find_values(self, PLOT_SERIES, &self->series, err) ||
        !find_values(self, PLOT_PANELS, &self->panels, err))
        return false;
    if (!self->is_map && self->series.count > CURVES_MAX)
        return REFUSE(err, "plot: %d curves: more than %d are too many", self->series.count,
                      CURVES_MAX);
    return (self->work = NEW_ARRAY(double, 6 * (int64_t)self->table.count, err)) != NULL;
}

// Doubts about a point, as bits. The error that counts is that of what is shown: of y, or of a
// map's colour.
static int32_t doubts_of(const PlotFigure *self, int32_t point)
{
    const double *errors = self->quantity[self->is_map ? PLOT_COLOR : PLOT_Y]->errors;
    return (self->table.warned[point] > 0 ? DOUBT_WARNED : 0) |
           (errors && isnan(errors[point]) ? DOUBT_NO_ERROR : 0);
}

// --- curves -------------------------------------------------------------------------------------

typedef struct PlotPoint {
    double x, y, error;
    int32_t doubts;
} PlotPoint;

// Points of one curve in one panel, along x: a line with marks and bars, and over it the open marks
// of points that are doubtful. points: [count of the table], work. A curve without points is not
// written.
static bool write_points(PlotFigure *self, int32_t which, int32_t panel, PlotPoint *points,
                         Curve curve, Error *err)
{
    const Quantity *key_x = self->quantity[PLOT_X], *key_y = self->quantity[PLOT_Y];
    int32_t found = 0;
    int32_t count = 0;
    for (int32_t k = 0; k < self->table.count; k++) {
        if (!values_hold(&self->series, which, k) || !values_hold(&self->panels, panel, k))
            continue;
        if (!isfinite(key_x->values[k]) || !isfinite(key_y->values[k])) continue;
        points[count++] = (PlotPoint){.x = key_x->values[k],
                                      .y = key_y->values[k],
                                      .error = key_y->errors ? key_y->errors[k] : (double)NAN,
                                      .doubts = doubts_of(self, k)};
    }
    if (count == 0) return true;
    qsort(points, (size_t)count, sizeof *points, order_doubles);
    double *x = self->work, *y = x + count, *error = y + count, *open = error + count;
    for (int32_t k = 0; k < count; k++) {
        x[k] = points[k].x;
        y[k] = points[k].y;
        error[k] = points[k].error;
        open[k] = points[k].doubts & DOUBT_WARNED ? y[k] : NAN;
        found |= points[k].doubts;
    }
    curve.count = count;
    curve.x = x;
    curve.y = y;
    curve.error = error;
    if (!figure_write_curve(&self->figure, &curve, err)) return false;
    self->found |= found;
    if (!(found & DOUBT_WARNED)) return true;
    curve.label = "";
    curve.line = "none";
    curve.filled = false;
    curve.y = open;
    curve.error = NULL;
    return figure_write_curve(&self->figure, &curve, err);
}

// Colours and marks tell curves apart, for print in grey too. The colours of two curves with the
// same mark differ in lightness.
static Curve curve_style(int32_t which, const char *label)
{
    static const char *const marker[MARKERS] = {"circle", "square", "triangle", "down"};
    return (Curve){.label = label,
                   .line = "thin",
                   .marker = marker[(which + which / MARKERS) % MARKERS],
                   .color = 1 + which % COLORS,
                   .filled = true};
}

// All curves of a panel; labelled where there is but one.
static bool write_curves(PlotFigure *self, int32_t panel, bool labelled, Error *err)
{
    char label[GROUP_LABEL_SIZE];
    PlotPoint *points = NEW_ARRAY(PlotPoint, self->table.count, err);
    TRY(points);
    for (int32_t k = 0; k < self->series.count; k++) {
        values_label(&self->series, k, self->plot->text[PLOT_SERIES], label);
        TRY(write_points(self, k, panel, points, curve_style(k, labelled ? label : ""), err));
    }
cleanup:
    memory_free(points);
    return error_is_clean(err);
}

// --- maps ---------------------------------------------------------------------------------------

static int compare_places(const void *left, const void *right)
{
    const double *a = left, *b = right;
    if (a[0] != b[0]) return a[0] < b[0] ? -1 : 1;
    return a[1] < b[1] ? -1 : a[1] > b[1];
}

// Writes the points of one panel as a map. ERROR_INPUT: two points are at one place, of which a map
// could show one.
static bool write_map(PlotFigure *self, int32_t panel, Error *err)
{
    const Quantity *const *quantity = self->quantity;
    const Quantity *lines = quantity[PLOT_CONTOURS];
    int32_t all = self->table.count, count = 0;
    double *x = self->work, *y = x + all, *value = y + all, *contour = value + all;
    double *open = contour + all, *places = NULL;
    for (int32_t k = 0; k < all; k++) {
        double at_x = quantity[PLOT_X]->values[k], at_y = quantity[PLOT_Y]->values[k];
        if (!values_hold(&self->panels, panel, k) || !isfinite(at_x + at_y)) continue;
        x[count] = at_x;
        y[count] = at_y;
        value[count] = quantity[PLOT_COLOR]->values[k];
        contour[count] = lines ? lines->values[k] : 0;
        bool has_value = isfinite(value[count]);
        int32_t doubts = has_value ? doubts_of(self, k) : 0, warned = doubts & DOUBT_WARNED;
        open[count++] = warned ? 1 : doubts ? 2 : 0;
        self->found |= warned ? warned : doubts;
        self->some_missing |= !has_value;
    }

    // Two points at one place are neighbours when the places are sorted.
    TRY((places = NEW_ARRAY(double, 2 * (int64_t)count, err)));
    for (int32_t k = 0; k < count; k++) {
        places[2 * k] = x[k];
        places[2 * k + 1] = y[k];
    }
    qsort(places, (size_t)count, 2 * sizeof *places, compare_places);
    for (int32_t k = 0; k + 1 < count; k++)
        if (compare_places(places + 2 * k, places + 2 * k + 2) == 0)
            FAIL(err, ERROR_INPUT,
                 "plot: a map shows one point at a place, and several have %s = %.6g, %s = "
                 "%.6g: name the key in which they differ in `panels`",
                 self->plot->text[PLOT_X], places[2 * k], self->plot->text[PLOT_Y],
                 places[2 * k + 1]);

    json_begin_object(self->figure.json, "map");
    TRY(figure_write_numbers(&self->figure, "x", x, count, err));
    TRY(figure_write_numbers(&self->figure, "y", y, count, err));
    TRY(figure_write_numbers(&self->figure, "value", value, count, err));
    TRY(figure_write_numbers(&self->figure, "open", open, count, err));
    if (lines) TRY(figure_write_numbers(&self->figure, "contour", contour, count, err));
    json_end(self->figure.json);
cleanup:
    memory_free(places);
    return error_is_clean(err);
}

// --- the whole ----------------------------------------------------------------------------------

// Standard deviation over mean of the differences of [count] rising values, or of the logarithms of
// their ratios.
static double step_scatter(const double *values, int32_t count, bool of_ratios)
{
    double sum = 0, squares = 0, steps = count - 1;
    for (int32_t k = 0; k + 1 < count; k++) {
        double step = of_ratios ? log(values[k + 1] / values[k]) : values[k + 1] - values[k];
        sum += step;
        squares += step * step;
    }
    double mean = sum / steps;
    return sqrt(fmax(squares / steps - mean * mean, 0)) / mean;
}

// Whether a logarithmic axis suits [count] values: above 0, and nearer to equal ratios than to
// equal differences.
static bool values_suit_log(const double *values, int32_t count, bool *suits, Error *err)
{
    int32_t kept = 0;
    double *sorted = NEW_ARRAY(double, count, err);
    *suits = false;
    if (!sorted) return false;
    for (int32_t k = 0; k < count; k++)
        if (isfinite(values[k])) sorted[kept++] = values[k];
    qsort(sorted, (size_t)kept, sizeof *sorted, order_doubles);
    int32_t found = kept > 0;
    for (int32_t k = 1; k < kept; k++)
        if (sorted[k] > sorted[found - 1]) sorted[found++] = sorted[k];
    if (found > 2 && sorted[0] > 0)
        *suits = step_scatter(sorted, found, true) < LOG_SUITS * step_scatter(sorted, found, false);
    memory_free(sorted);
    return true;
}

static bool write_figure(PlotFigure *self, Error *err)
{
    JsonWriter *json = NULL;
    const StudyPlot *plot = self->plot;
    bool has_panels = self->panels.count > 1, is_log[2] = {plot->log_x, plot->log_y};
    TRY(figure_begin(&self->figure, err));
    for (PlotKey key = PLOT_X; key <= PLOT_Y; key++) {
        const Quantity *quantity = self->quantity[key];
        if (self->is_map && !plot->log_given)
            TRY(values_suit_log(quantity->values, self->table.count, &is_log[key], err));
        QuantityLabel label = quantity->label;
        const char *equals = strchr(plot->text[key], '=');
        label.column = equals ? equals + strspn(equals, "= ") : plot->text[key];
        figure_write_axis(&self->figure, plot_key_name(key), label.words, label.unit, label.column,
                          is_log[key] ? "log" : "linear");
    }
    for (PlotKey key = PLOT_COLOR; key <= PLOT_CONTOURS; key++) {
        if (!self->quantity[key]) continue;
        const QuantityLabel *label = &self->quantity[key]->label;
        figure_write_axis(&self->figure, plot_key_name(key), label->words, label->unit,
                          label->column, NULL);
    }

    // Panels, each with its map or its curves.
    json = self->figure.json;
    if (has_panels) json_begin_list(json, "panels");
    for (int32_t k = 0; has_panels && k < self->panels.count; k++) {
        char panel[GROUP_LABEL_SIZE];
        values_label(&self->panels, k, plot->text[PLOT_PANELS], panel);
        json_begin_object(json, NULL);
        json_text(json, "title", panel);
        if (self->is_map) {
            TRY(write_map(self, k, err));
        } else {
            json_begin_list(json, "series");
            TRY(write_curves(self, k, false, err));
            json_end(json);
        }
        json_end(json);
    }
    if (has_panels) json_end(json);
    if (!has_panels && self->is_map) TRY(write_map(self, 0, err));

    // Curves without panels; with panels the entries of the legend, once for all of them.
    json_begin_list(json, "series");
    if (!self->is_map && !has_panels) TRY(write_curves(self, 0, true, err));
    for (int32_t k = 0; !self->is_map && has_panels && k < self->series.count; k++) {
        char name[GROUP_LABEL_SIZE];
        values_label(&self->series, k, plot->text[PLOT_SERIES], name);
        Curve curve = curve_style(k, name);
        if (name[0]) TRY(figure_write_entry(&self->figure, &curve, err));
    }

    // The legend of a map: its contours, and points that have no value.
    char words[QUANTITY_LABEL_SIZE + 40];
    const Quantity *color = self->quantity[PLOT_COLOR], *lines = self->quantity[PLOT_CONTOURS];
    if (self->is_map && lines) {
        int32_t panels = has_panels ? self->panels.count : 1;   // of NaN alone there are none
        bool many = self->table.count / panels > MAP_MANY;
        snprintf(words, sizeof words, many ? "%s, medians of %d x %d points" : "%s",
                 lines->label.words, MAP_MEDIANS, MAP_MEDIANS);
        Curve line = {.label = words, .line = "solid"};
        TRY(figure_write_entry(&self->figure, &line, err));
    }
    if (self->is_map && self->some_missing) {
        bool formula = strchr(plot->text[PLOT_COLOR], '=') != NULL;
        snprintf(words, sizeof words, "no %s", formula ? "value" : color->label.words);
        Curve missing = {.label = words, .line = "none", .marker = "cross"};
        TRY(figure_write_entry(&self->figure, &missing, err));
    }
    TRY(figure_write_doubts(&self->figure, self->found, self->is_map, err));
    json_end(json);
cleanup:
    return error_is_clean(err);
}

bool sweep_plot_draw(const char *folder, const char *beside, const StudyPlot *plot,
                     const PictureStyle *style, Error *err)
{
    char compare[AMONTONS_PATH_SIZE];
    PlotFigure self = {.figure = {.folder = folder, .name = plot->name, .style = style},
                       .plot = plot,
                       .is_map = plot->text[PLOT_COLOR][0]};
    TRY(open_table(&self, folder, err));
    if (beside) TRY(open_check_named(plot->compare, err));   // else of the command line
    if (plot->compare[0]) {
        if (!folder_beside(beside, plot->compare, compare, sizeof compare))
            FAIL(err, ERROR_INPUT, "plot: the path %.60s is too long", plot->compare);
        self.figure.compare = compare;
    }
    // The study's title is that of its own plots.
    self.figure.title = beside ? self.table.title : "";
    write_figure(&self, err);
    figure_end(&self.figure, err);
cleanup:
    for (int32_t k = 0; k < PLOT_KEYS; k++) quantity_destroy(&self.made[k]);
    memory_free(self.work);
    plot_table_close(&self.table);
    return error_is_clean(err);
}
