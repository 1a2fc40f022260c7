// SPDX-License-Identifier: GPL-2.0-or-later
// Curves: one for each value of `series` and each sweep, told apart by colours and marks. Maps: one
// for each sweep. `panels` draws each value of a key in a frame of its own. Bars are the errors of
// the table; open marks are points whose runs warned, marks without a bar (of a map: squares) those
// whose error is not known.
#include "study/sweep/showing/figure_plot.h"

#include "base/memory.h"
#include "base/order.h"
#include "io/files/folder.h"
#include "render/picture_options.h"
#include "study/sweep/showing/plot_sources.h"
#include "study/sweep/showing/figure_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CURVES_MAX = 15, COLORS = 7, MARKERS = 4 };

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

static bool folder_of(const char *beside, const char *given, char folder[AMONTONS_PATH_SIZE],
                      Error *err)
{
    return folder_beside(beside, given, folder, AMONTONS_PATH_SIZE) ||
           REFUSE(err, "plot: the path %.60s is too long", given);
}

// The title of its study; where another sweep has the same, its folder.
static const char *sweep_name(const PlotFigure *self, const Source *source)
{
    for (int32_t k = 0; k < self->source_count; k++) {
        const PlotTable *other = &self->sources[k].table;
        if (other != &source->table && strcmp(other->title, source->table.title) == 0)
            return source->table.name;
    }
    return source->table.title;
}

// The sweep's name, where it is needed, and the value of the key that tells panels or curves apart.
static void value_label(const PlotFigure *self, const Source *source, PlotKey key, int32_t which,
                        char label[GROUP_LABEL_SIZE])
{
    char value[GROUP_LABEL_SIZE];
    bool names_sweep = self->source_count > 1 && (self->is_map || key == PLOT_SERIES);
    values_label(key == PLOT_SERIES ? &source->series : &source->panels, which,
                 self->plot->text[key], value);
    snprintf(label, GROUP_LABEL_SIZE, "%.40s%s%.50s", names_sweep ? sweep_name(self, source) : "",
             names_sweep && value[0] ? ", " : "", value);
}

static bool add_labels(PlotFigure *self, const Source *source, Error *err)
{
    char label[GROUP_LABEL_SIZE];
    double ignored = 0;
    for (int32_t k = 0; k < source->panels.count; k++) {
        value_label(self, source, PLOT_PANELS, k, label);
        if (!words_index(&self->panels, label, &ignored, err)) return false;
    }
    for (int32_t k = 0; k < source->series.count; k++) {
        values_label(&source->series, k, self->plot->text[PLOT_SERIES], label);
        if (!words_index(&self->curves, label, &ignored, err)) return false;
    }
    return true;
}

static bool open_sources(PlotFigure *self, const char *folder, const char *beside, Error *err)
{
    int32_t largest = 0, curves = 0;
    if (!(self->sources = NEW_ARRAY(Source, SOURCES_MAX, err))) return false;
    self->source_count = 1 + self->plot->with_count;
    for (int32_t k = 0; k < self->source_count; k++) {
        char path[AMONTONS_PATH_SIZE];
        Source *source = &self->sources[k];
        if (k > 0 && !folder_of(beside, self->plot->with[k - 1], path, err)) return false;
        if (!source_open(k > 0 ? path : folder, self->plot, &self->doubts, source, err))
            return false;
        if (source->table.count > largest) largest = source->table.count;
        curves += source->series.count;
    }
    for (int32_t k = 0; k < self->source_count; k++)
        if (!add_labels(self, &self->sources[k], err)) return false;
    if (!self->is_map && curves > CURVES_MAX)
        return REFUSE(err, "plot: %d curves: more than %d are too many", curves, CURVES_MAX);
    return (self->work = NEW_ARRAY(double, 6 * (int64_t)largest, err)) != NULL;
}

// --- curves -------------------------------------------------------------------------------------

typedef struct PlotPoint {
    double x, y, error;
    uint32_t doubts;
} PlotPoint;

// Those of one curve in one panel, along x. points: [count of the table]. Returns how many.
static int32_t gather_points(const Source *source, int32_t curve, int32_t panel, PlotPoint *points)
{
    const Quantity *x = source->quantity[PLOT_X], *y = source->quantity[PLOT_Y];
    int32_t count = 0;
    for (int32_t k = 0; k < source->table.count; k++) {
        if (!values_hold(&source->series, curve, k) || !values_hold(&source->panels, panel, k))
            continue;
        if (!isfinite(x->values[k]) || !isfinite(y->values[k])) continue;
        points[count++] = (PlotPoint){.x = x->values[k],
                                      .y = y->values[k],
                                      .error = y->errors ? y->errors[k] : (double)NAN,
                                      .doubts = source->doubts[k]};
    }
    qsort(points, (size_t)count, sizeof *points, order_doubles);
    return count;
}

// A line with marks and bars, and over it the open marks of points that are doubtful.
static bool write_points(PlotFigure *self, const PlotPoint *points, int32_t count, Curve curve,
                         Error *err)
{
    double *x = self->work, *y = x + count, *error = y + count, *open = error + count;
    uint32_t found = 0;
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
    if (found & ~DOUBT_NO_ERROR) {
        curve.label = "";
        curve.line = "none";
        curve.filled = false;
        curve.y = open;
        curve.error = NULL;
        if (!figure_write_curve(&self->figure, &curve, err)) return false;
    }
    return true;
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
                int32_t count = gather_points(source, k, p, points);
                if (count > 0) TRY(write_points(self, points, count, curve, err));
            }
        }
    }
cleanup:
    memory_free(points);
    return error_is_clean(err);
}

// Writes the legend's entries of the curves, once for all panels.
static bool write_curve_entries(PlotFigure *self, Error *err)
{
    for (int32_t s = 0; s < self->source_count; s++)
        for (int32_t k = 0; k < self->sources[s].series.count; k++) {
            char label[GROUP_LABEL_SIZE];
            value_label(self, &self->sources[s], PLOT_SERIES, k, label);
            Curve curve = curve_style(self, s, k, label);
            if (label[0] && !figure_write_entry(&self->figure, &curve, err)) return false;
        }
    return true;
}

// --- maps ---------------------------------------------------------------------------------------

static int compare_places(const void *left, const void *right)
{
    const double *a = left, *b = right;
    if (a[0] != b[0]) return a[0] < b[0] ? -1 : 1;
    return a[1] < b[1] ? -1 : a[1] > b[1];
}

// ERROR_INPUT: two points at one place, of which a map could show one.
static bool check_places(const PlotFigure *self, const double *x, const double *y, int32_t count,
                         Error *err)
{
    double *places = NEW_ARRAY(double, 2 * (int64_t)count, err);
    TRY(places);
    for (int32_t k = 0; k < count; k++) {
        places[2 * k] = x[k];
        places[2 * k + 1] = y[k];
    }
    qsort(places, (size_t)count, 2 * sizeof *places, compare_places);
    for (int32_t k = 0; k + 1 < count; k++)
        if (compare_places(places + 2 * k, places + 2 * k + 2) == 0)
            FAIL(err, ERROR_INPUT,
                 "plot: a map shows one point at a place, and several have %s = %.6g, %s = %.6g: "
                 "name the key in which they differ in `panels`",
                 self->plot->text[PLOT_X], places[2 * k], self->plot->text[PLOT_Y],
                 places[2 * k + 1]);
cleanup:
    memory_free(places);
    return error_is_clean(err);
}

static bool write_map(PlotFigure *self, const Source *source, int32_t panel, Error *err)
{
    const Quantity *const *quantity = source->quantity;
    const Quantity *lines = quantity[PLOT_CONTOURS];
    int32_t all = source->table.count, count = 0;
    double *x = self->work, *y = x + all, *value = y + all, *contour = value + all;
    double *open = contour + all;
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
    if (!check_places(self, x, y, count, err)) return false;
    json_begin_object(self->figure.json, "map");
    if (!figure_write_numbers(&self->figure, "x", x, count, err)) return false;
    if (!figure_write_numbers(&self->figure, "y", y, count, err)) return false;
    if (!figure_write_numbers(&self->figure, "value", value, count, err)) return false;
    if (!figure_write_numbers(&self->figure, "open", open, count, err)) return false;
    if (lines && !figure_write_numbers(&self->figure, "contour", contour, count, err)) return false;
    json_end(self->figure.json);
    return true;
}

// Those of the panel called `panel`: one.
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

static bool write_map_entries(PlotFigure *self, Error *err)
{
    const Quantity *const *quantity = self->sources[0].quantity;
    char label[QUANTITY_LABEL_SIZE + 40];
    if (quantity[PLOT_CONTOURS]) {
        bool many = self->sources[0].table.count / self->panels.count > MAP_MANY;
        snprintf(label, sizeof label, many ? "%s, medians of %d x %d points" : "%s",
                 quantity[PLOT_CONTOURS]->label.words, MAP_MEDIANS, MAP_MEDIANS);
        Curve line = {.label = label, .line = "solid"};
        if (!figure_write_entry(&self->figure, &line, err)) return false;
    }
    bool formula = strchr(self->plot->text[PLOT_COLOR], '=') != NULL;
    snprintf(label, sizeof label, "no %s", formula ? "value" : quantity[PLOT_COLOR]->label.words);
    Curve missing = {.label = label, .line = "none", .marker = "cross"};
    return !self->some_missing || figure_write_entry(&self->figure, &missing, err);
}

// --- the whole ----------------------------------------------------------------------------------

static bool write_axes(PlotFigure *self, Error *err)
{
    const StudyPlot *plot = self->plot;
    const Source *source = &self->sources[0];
    bool is_log[2] = {plot->log_x, plot->log_y};
    for (PlotKey key = PLOT_X; key <= PLOT_Y; key++) {
        const Quantity *quantity = source->quantity[key];
        if (self->is_map && !plot->log_given &&
            !values_suit_log(quantity->values, source->table.count, &is_log[key], err))
            return false;
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
    return true;
}

static bool write_panels(PlotFigure *self, Error *err)
{
    JsonWriter *json = self->figure.json;
    json_begin_list(json, "panels");
    for (int32_t k = 0; k < self->panels.count; k++) {
        const char *panel = self->panels.words[k];
        json_begin_object(json, NULL);
        json_text(json, "title", panel);
        if (self->is_map) {
            if (!write_maps(self, panel, err)) return false;
        } else {
            json_begin_list(json, "series");
            if (!write_curves(self, panel, false, err)) return false;
            json_end(json);
        }
        json_end(json);
    }
    json_end(json);
    return true;
}

static bool write_figure(PlotFigure *self, Error *err)
{
    bool has_panels = self->panels.count > 1;
    TRY(figure_begin(&self->figure, err));
    TRY(write_axes(self, err));
    if (has_panels) TRY(write_panels(self, err));
    if (!has_panels && self->is_map) TRY(write_maps(self, self->panels.words[0], err));
    json_begin_list(self->figure.json, "series");
    if (self->is_map)
        TRY(write_map_entries(self, err));
    else if (has_panels)
        TRY(write_curve_entries(self, err));
    else
        TRY(write_curves(self, self->panels.words[0], true, err));
    TRY(figure_write_doubts(&self->figure, &self->doubts, self->found, self->is_map, err));
    json_end(self->figure.json);
cleanup:
    return error_is_clean(err);
}

bool figure_of_plot(const char *folder, const char *beside, const StudyPlot *plot,
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
    for (int32_t k = 0; self.sources && k < self.source_count; k++) source_close(&self.sources[k]);
    memory_free_all(self.sources, self.work);
    words_destroy(&self.doubts);
    words_destroy(&self.curves);
    words_destroy(&self.panels);
    return error_is_clean(err);
}
