// SPDX-License-Identifier: GPL-2.0-or-later
// Curves: one for each value of `series` and each sweep, told apart by colours and marks. Maps: one
// for each sweep. `panels` draws each value of a key in a frame of its own. Bars are the errors of
// the table; open marks are points whose runs warned, marks without a bar (of a map: squares) those
// whose error is not known.
#include "study/sweep/showing/sweep_plot.h"

#include "base/memory.h"
#include "base/order.h"
#include "io/files/folder.h"
#include "render/picture_options.h"
#include "study/sweep/reading/study_wanted.h"
#include "study/sweep/showing/figure_file.h"
#include "study/sweep/showing/plot_table.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CURVES_MAX = 15, COLORS = 7, MARKERS = 4 };
enum { SOURCES_MAX = 1 + PLOT_WITH_MAX, VALUES_MAX = 24, GROUP_LABEL_SIZE = 96 };
enum { DOUBTS_MAX = 31 };   // names; the last one stands for all that are more

static const double LOG_SUITS = 0.75;   // scatter of ratios (their logarithms) over that of steps

// The different values of a key, in the order of the points; one without value where none is asked.
typedef struct Values {
    const Quantity *key;   // NULL: all points belong together
    int32_t count;
    double value[VALUES_MAX];
} Values;

// One sweep.
typedef struct Source {
    PlotTable table;   // owned, as the next
    Quantity made[PLOT_KEYS];   // of formulas
    const Quantity *quantity[PLOT_KEYS];   // NULL: not asked for
    Values series, panels;
    uint32_t *doubts;   // [table.count] bits: of the names in PlotFigure, and the last one: error
        // not known; owned
} Source;

typedef struct PlotFigure {
    Figure figure;
    const StudyPlot *plot;
    bool is_map;
    int32_t source_count;
    Source *sources;   // [SOURCES_MAX]; owned, as the next two
    WordList doubts;   // of all sweeps
    WordList curves, panels;   // their labels; one empty one where no key tells them apart
    uint32_t found;   // of `doubts`, among what is drawn
    bool some_missing;   // points of a map have no value
    double *work;   // [6 * points of the largest table]; owned
} PlotFigure;

// --- sweeps -------------------------------------------------------------------------------------

// Lists the different values of a key, which are told apart by curves or panels.
static bool find_values(const Source *source, const Quantity *key, const char *name, Values *values,
                        Error *err)
{
    *values = (Values){.key = key};
    values->count = key ? 0 : 1;
    for (int32_t k = 0; key && k < source->table.count; k++) {
        int32_t at = 0;
        while (at < values->count && values->value[at] != key->values[k]) at++;
        if (at < values->count || isnan(key->values[k])) continue;
        if (values->count == VALUES_MAX)
            return REFUSE(err, "plot: %s has more than %d values: too many curves or panels", name,
                          VALUES_MAX);
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

static bool folder_of(const char *beside, const char *given, char folder[AMONTONS_PATH_SIZE],
                      Error *err)
{
    return folder_beside(beside, given, folder, AMONTONS_PATH_SIZE) ||
           REFUSE(err, "plot: the path %.60s is too long", given);
}

// The sweep's name, where it is needed, and the value of the key that tells panels or curves apart.
static void value_label(const PlotFigure *self, const Source *source, PlotKey key, int32_t which,
                        char label[GROUP_LABEL_SIZE])
{
    char value[GROUP_LABEL_SIZE];
    bool names_sweep = self->source_count > 1 && (self->is_map || key == PLOT_SERIES);
    values_label(key == PLOT_SERIES ? &source->series : &source->panels, which,
                 self->plot->text[key], value);

    // A sweep has the title of its study; where another sweep has the same, the name of its folder.
    const char *name = names_sweep ? source->table.title : "";
    for (int32_t k = 0; names_sweep && k < self->source_count; k++) {
        const PlotTable *other = &self->sources[k].table;
        if (other != &source->table && strcmp(other->title, source->table.title) == 0)
            name = source->table.name;
    }
    snprintf(label, GROUP_LABEL_SIZE, "%.40s%s%.50s", name, names_sweep && value[0] ? ", " : "",
             value);
}

// Reads the quantities of all sweeps, which of their points are doubtful, and labels of panels and
// curves. ERROR_INPUT: a name that a table does not have, words where numbers are needed, too many
// values of a key.
static bool open_sources(PlotFigure *self, const char *folder, const char *beside, Error *err)
{
    const StudyPlot *plot = self->plot;
    int32_t largest = 0, curves = 0;
    if (!(self->sources = NEW_ARRAY(Source, SOURCES_MAX, err))) return false;
    self->source_count = 1 + plot->with_count;
    for (int32_t k = 0; k < self->source_count; k++) {
        char path[AMONTONS_PATH_SIZE];   // of another sweep (k > 0); the first is in `folder`
        Source *source = &self->sources[k];
        if (k > 0 && !folder_of(beside, plot->with[k - 1], path, err)) return false;
        PlotTable *table = &source->table;
        double place[DOUBTS_MAX];
        if (!plot_table_open(k > 0 ? path : folder, table, err)) return false;
        for (PlotKey key = PLOT_X; key < PLOT_KEYS; key++) {
            if (!plot->text[key][0]) continue;
            source->quantity[key] =
                plot_table_find(table, plot->text[key], &source->made[key], err);
            if (!source->quantity[key]) return false;
            if (key < PLOT_SERIES && source->quantity[key]->words.count > 0)
                return REFUSE(
                    err, "plot: %s has words, not numbers: it can be the `series` or the `panels`",
                    plot->text[key]);
        }

        // Bits of the sweep's own names of warnings become those of all sweeps' names. The errors
        // that count are those of what is shown: of y, or of a map's colour.
        const Quantity *shown = source->quantity[plot->text[PLOT_COLOR][0] ? PLOT_COLOR : PLOT_Y];
        int32_t kinds = table->kinds.count < DOUBTS_MAX ? table->kinds.count : DOUBTS_MAX;
        if (!(source->doubts = NEW_ARRAY(uint32_t, table->count, err))) return false;
        for (int32_t kind = 0; kind < kinds; kind++)
            if (!words_index(&self->doubts, table->kinds.words[kind], &place[kind], err))
                return false;
        for (int32_t i = 0; i < table->count; i++) {
            for (int32_t kind = 0; kind < kinds; kind++)
                if ((uint32_t)table->warned[i] >> kind & 1)
                    source->doubts[i] |= (uint32_t)1 << (int32_t)fmin(place[kind], DOUBTS_MAX - 1);
            if (shown->errors && isnan(shown->errors[i])) source->doubts[i] |= DOUBT_NO_ERROR;
        }

        // Finds the values that curves and panels tell apart.
        if (!find_values(source, source->quantity[PLOT_SERIES], plot->text[PLOT_SERIES],
                         &source->series, err) ||
            !find_values(source, source->quantity[PLOT_PANELS], plot->text[PLOT_PANELS],
                         &source->panels, err))
            return false;
        if (source->table.count > largest) largest = source->table.count;
        curves += source->series.count;
    }
    for (int32_t k = 0; k < self->source_count; k++) {
        const Source *source = &self->sources[k];
        char label[GROUP_LABEL_SIZE];
        double ignored = 0;
        for (int32_t i = 0; i < source->panels.count; i++) {
            value_label(self, source, PLOT_PANELS, i, label);
            if (!words_index(&self->panels, label, &ignored, err)) return false;
        }
        for (int32_t i = 0; i < source->series.count; i++) {
            values_label(&source->series, i, plot->text[PLOT_SERIES], label);
            if (!words_index(&self->curves, label, &ignored, err)) return false;
        }
    }
    if (!self->is_map && curves > CURVES_MAX)
        return REFUSE(err, "plot: %d curves: more than %d are too many", curves, CURVES_MAX);
    return (self->work = NEW_ARRAY(double, 6 * (int64_t)largest, err)) != NULL;
}

// --- curves -------------------------------------------------------------------------------------

typedef struct PlotPoint {
    double x, y, error;
    uint32_t doubts;
} PlotPoint;

// Points of one curve in one panel, along x: a line with marks and bars, and over it the open marks
// of points that are doubtful. points: [count of the table], work. A curve without points is not
// written.
static bool write_points(PlotFigure *self, const Source *source, int32_t which, int32_t panel,
                         PlotPoint *points, Curve curve, Error *err)
{
    const Quantity *key_x = source->quantity[PLOT_X], *key_y = source->quantity[PLOT_Y];
    uint32_t found = 0;
    int32_t count = 0;
    for (int32_t k = 0; k < source->table.count; k++) {
        if (!values_hold(&source->series, which, k) || !values_hold(&source->panels, panel, k))
            continue;
        if (!isfinite(key_x->values[k]) || !isfinite(key_y->values[k])) continue;
        points[count++] = (PlotPoint){.x = key_x->values[k],
                                      .y = key_y->values[k],
                                      .error = key_y->errors ? key_y->errors[k] : (double)NAN,
                                      .doubts = source->doubts[k]};
    }
    if (count == 0) return true;
    qsort(points, (size_t)count, sizeof *points, order_doubles);
    double *x = self->work, *y = x + count, *error = y + count, *open = error + count;
    for (int32_t k = 0; k < count; k++) {
        x[k] = points[k].x;
        y[k] = points[k].y;
        error[k] = points[k].error;
        open[k] = points[k].doubts & ~DOUBT_NO_ERROR ? y[k] : NAN;
        found |= points[k].doubts;
    }
    curve.count = count;
    curve.x = x;
    curve.y = y;
    curve.error = error;
    if (!figure_write_curve(&self->figure, &curve, err)) return false;
    self->found |= found;
    if (!(found & ~DOUBT_NO_ERROR)) return true;
    curve.label = "";
    curve.line = "none";
    curve.filled = false;
    curve.y = open;
    curve.error = NULL;
    return figure_write_curve(&self->figure, &curve, err);
}

// Colours and marks tell curves apart, for print in grey too. Where there are several sweeps
// colours tell values of `series` apart, marks sweeps; without `series` colours do that, too.
static Curve curve_style(PlotFigure *self, int32_t source, int32_t which, const char *label)
{
    static const char *const marker[MARKERS] = {"circle", "square", "triangle", "down"};
    char value[GROUP_LABEL_SIZE];
    const Values *series = &self->sources[source].series;
    double color = source;
    Error ignored = {0};
    values_label(series, which, self->plot->text[PLOT_SERIES], value);
    if (series->key) words_index(&self->curves, value, &color, &ignored);   // is there
    // The colours of two curves with the same mark differ in lightness.
    int32_t mark = self->source_count > 1 ? source : (int32_t)color;
    return (Curve){.label = label,
                   .line = "thin",
                   .marker = marker[(mark + mark / MARKERS) % MARKERS],
                   .color = 1 + (int32_t)color % COLORS,
                   .filled = true};
}

// All curves of the panel called `panel`; labelled where there is but one.
static bool write_curves(PlotFigure *self, const char *panel, bool labelled, Error *err)
{
    PlotPoint *points = NULL;
    for (int32_t s = 0; s < self->source_count; s++) {
        Source *source = &self->sources[s];
        memory_free(points);
        TRY(points = NEW_ARRAY(PlotPoint, source->table.count, err));
        for (int32_t p = 0; p < source->panels.count; p++) {
            char label[GROUP_LABEL_SIZE];
            value_label(self, source, PLOT_PANELS, p, label);
            if (strcmp(label, panel) != 0) continue;
            for (int32_t k = 0; k < source->series.count; k++) {
                value_label(self, source, PLOT_SERIES, k, label);
                Curve curve = curve_style(self, s, k, labelled ? label : "");
                TRY(write_points(self, source, k, p, points, curve, err));
            }
        }
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

// Writes the points of one panel of a sweep as a map. ERROR_INPUT: two points are at one place, of
// which a map could show one.
static bool write_map(PlotFigure *self, const Source *source, int32_t panel, Error *err)
{
    const Quantity *const *quantity = source->quantity;
    const Quantity *lines = quantity[PLOT_CONTOURS];
    int32_t all = source->table.count, count = 0;
    double *x = self->work, *y = x + all, *value = y + all, *contour = value + all;
    double *open = contour + all, *places = NULL;
    for (int32_t k = 0; k < all; k++) {
        double at_x = quantity[PLOT_X]->values[k], at_y = quantity[PLOT_Y]->values[k];
        if (!values_hold(&source->panels, panel, k) || !isfinite(at_x + at_y)) continue;
        x[count] = at_x;
        y[count] = at_y;
        value[count] = quantity[PLOT_COLOR]->values[k];
        contour[count] = lines ? lines->values[k] : 0;
        bool has_value = isfinite(value[count]);
        uint32_t doubts = has_value ? source->doubts[k] : 0, warned = doubts & ~DOUBT_NO_ERROR;
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

// Writes the map of the panel called `panel`, of whichever sweep has it.
static bool write_maps(PlotFigure *self, const char *panel, Error *err)
{
    for (int32_t s = 0; s < self->source_count; s++)
        for (int32_t p = 0; p < self->sources[s].panels.count; p++) {
            char label[GROUP_LABEL_SIZE];
            value_label(self, &self->sources[s], PLOT_PANELS, p, label);
            if (strcmp(label, panel) == 0 && !write_map(self, &self->sources[s], p, err))
                return false;
        }
    return true;
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
    const Source *source = &self->sources[0];
    bool has_panels = self->panels.count > 1, is_log[2] = {plot->log_x, plot->log_y};
    TRY(figure_begin(&self->figure, err));
    for (PlotKey key = PLOT_X; key <= PLOT_Y; key++) {
        const Quantity *quantity = source->quantity[key];
        if (self->is_map && !plot->log_given)
            TRY(values_suit_log(quantity->values, source->table.count, &is_log[key], err));
        QuantityLabel label = quantity->label;
        const char *equals = strchr(plot->text[key], '=');
        label.column = equals ? equals + strspn(equals, "= ") : plot->text[key];
        figure_write_axis(&self->figure, plot_key_name(key), &label,
                          is_log[key] ? "log" : "linear");
    }
    if (source->quantity[PLOT_COLOR])
        figure_write_axis(&self->figure, "color", &source->quantity[PLOT_COLOR]->label, NULL);
    if (source->quantity[PLOT_CONTOURS])
        figure_write_axis(&self->figure, "contours", &source->quantity[PLOT_CONTOURS]->label, NULL);

    // Panels, each with its map or its curves.
    json = self->figure.json;
    if (has_panels) json_begin_list(json, "panels");
    for (int32_t k = 0; has_panels && k < self->panels.count; k++) {
        const char *panel = self->panels.words[k];
        json_begin_object(json, NULL);
        json_text(json, "title", panel);
        if (self->is_map) {
            TRY(write_maps(self, panel, err));
        } else {
            json_begin_list(json, "series");
            TRY(write_curves(self, panel, false, err));
            json_end(json);
        }
        json_end(json);
    }
    if (has_panels) json_end(json);
    if (!has_panels && self->is_map) TRY(write_maps(self, self->panels.words[0], err));

    // Curves without panels; with panels the entries of the legend, once for all of them.
    json_begin_list(json, "series");
    if (!self->is_map && !has_panels) TRY(write_curves(self, self->panels.words[0], true, err));
    for (int32_t s = 0; !self->is_map && has_panels && s < self->source_count; s++)
        for (int32_t k = 0; k < self->sources[s].series.count; k++) {
            char name[GROUP_LABEL_SIZE];
            value_label(self, &self->sources[s], PLOT_SERIES, k, name);
            Curve curve = curve_style(self, s, k, name);
            if (name[0]) TRY(figure_write_entry(&self->figure, &curve, err));
        }

    // The legend of a map: its contours, and points that have no value.
    char words[QUANTITY_LABEL_SIZE + 40];
    const Quantity *color = source->quantity[PLOT_COLOR], *lines = source->quantity[PLOT_CONTOURS];
    if (self->is_map && lines) {
        bool many = source->table.count / self->panels.count > MAP_MANY;
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
    TRY(figure_write_doubts(&self->figure, &self->doubts, self->found, self->is_map, err));
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
    TRY(open_sources(&self, folder, beside, err));
    if (plot->compare[0]) {
        TRY(folder_of(beside, plot->compare, compare, err));
        self.figure.compare = compare;
    }
    bool of_study = beside && plot->with_count == 0;   // else its title says something else
    self.figure.title = of_study ? self.sources[0].table.title : "";
    write_figure(&self, err);
    figure_end(&self.figure, err);
cleanup:
    for (int32_t s = 0; self.sources && s < self.source_count; s++) {
        Source *source = &self.sources[s];
        for (int32_t k = 0; k < PLOT_KEYS; k++) quantity_destroy(&source->made[k]);
        memory_free(source->doubts);
        plot_table_close(&source->table);
    }
    memory_free_all(self.sources, self.work);
    words_destroy(&self.doubts);
    words_destroy(&self.curves);
    words_destroy(&self.panels);
    return error_is_clean(err);
}
