// SPDX-License-Identifier: GPL-2.0-or-later
// The file is read key by key; what is given twice, unknown or of the wrong kind is refused with
// its place. Ends of the axes that the file leaves open are found last, from all series.
#include "render/plot_file.h"

#include "base/memory.h"
#include "io/yaml_document.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { UNIT_SIZE = 16 };

static const double MARGIN = 0.05;   // of the data's range, beside the data
static const double HEIGHT_STANDARD = 0.75;

static const char *const MARKERS[] = {"none", "circle", "square", "triangle", "down", NULL};
static const char *const LINES[] = {"none", "solid", "thin", "dashed", NULL};
static const char *const CORNERS[] = {"auto",       "none",        "upper-right", "upper-left",
                                      "lower-left", "lower-right", "outside",     NULL};
static const char *const SCALES[] = {"linear", "log", NULL};

typedef struct PlotReader {
    YamlDocument *file;
    Error *err;
} PlotReader;

static bool refuse(const PlotReader *reader, YamlNode node, const char *what, const char *allowed)
{
    return yaml_refuse(reader->file, node, what, allowed, reader->err);
}

// The child of `map` called `key`; a key that is in none of the `known` names is refused.
static YamlNode child(const PlotReader *reader, YamlNode map, const char *key)
{
    for (YamlNode item = yaml_first(reader->file, map); item != YAML_NO_NODE;
         item = yaml_next(reader->file, item))
        if (strcmp(yaml_key(reader->file, item), key) == 0) return item;
    return YAML_NO_NODE;
}

// known: names with a space behind each.
static bool check_keys(const PlotReader *reader, YamlNode map, const char *what, const char *known)
{
    if (yaml_kind(reader->file, map) != YAML_MAP) return refuse(reader, map, what, "a map of keys");
    for (YamlNode item = yaml_first(reader->file, map); item != YAML_NO_NODE;
         item = yaml_next(reader->file, item)) {
        char key[40];
        snprintf(key, sizeof key, "%.37s ", yaml_key(reader->file, item));
        const char *at = strstr(known, key);
        if (at && (at == known || at[-1] == ' ')) continue;
        yaml_key_error(reader->file, item, reader->err, "%s: unknown key `%.40s`; allowed: %s",
                       what, yaml_key(reader->file, item), known);
        return false;
    }
    return true;
}

// *choice keeps its value where the key is missing. names: NULL at the end.
static bool read_choice(const PlotReader *reader, YamlNode map, const char *key,
                        const char *const *names, int32_t *choice)
{
    char allowed[200] = "";
    YamlNode node = child(reader, map, key);
    if (node == YAML_NO_NODE) return true;
    for (int32_t k = 0; names[k]; k++) {
        size_t used = strlen(allowed);
        snprintf(allowed + used, sizeof allowed - used, "%s%s", k ? ", " : "", names[k]);
        if (strcmp(yaml_text(reader->file, node), names[k]) != 0) continue;
        *choice = k;
        return true;
    }
    return refuse(reader, node, key, allowed);
}

// text keeps what it holds where the key is missing.
static bool read_text(const PlotReader *reader, YamlNode map, const char *key, char *text,
                      size_t size)
{
    YamlNode node = child(reader, map, key);
    if (node == YAML_NO_NODE) return true;
    const char *given = yaml_text(reader->file, node);
    if (yaml_kind(reader->file, node) != YAML_SCALAR || strlen(given) >= size)
        return refuse(reader, node, key, "a text, not too long");
    memcpy(text, given, strlen(given) + 1);
    return true;
}

// null is NaN.
static bool read_number(const PlotReader *reader, YamlNode node, const char *what, double *value)
{
    char *end = NULL;
    const char *text = yaml_text(reader->file, node);
    *value = NAN;
    if (yaml_kind(reader->file, node) == YAML_NOTHING) return true;
    *value = strtod(text, &end);
    if (yaml_kind(reader->file, node) == YAML_SCALAR && *text && !*end && isfinite(*value))
        return true;
    return refuse(reader, node, what, "a number, or null");
}

// [count] numbers of a list, exactly `wanted` where that is not negative.
static bool read_numbers(const PlotReader *reader, YamlNode list, const char *what, int32_t wanted,
                         double *values)
{
    int32_t k = 0;
    bool good = yaml_kind(reader->file, list) == YAML_LIST &&
                yaml_count(reader->file, list) == wanted;
    char allowed[60];
    snprintf(allowed, sizeof allowed, "a list of %d numbers", wanted);
    if (!good) return refuse(reader, list, what, allowed);
    for (YamlNode item = yaml_first(reader->file, list); item != YAML_NO_NODE;
         item = yaml_next(reader->file, item))
        if (!read_number(reader, item, what, &values[k++])) return false;
    return true;
}

// *values: [count], owned by the series; NULL where the key is missing.
static bool read_array(const PlotReader *reader, YamlNode map, const char *key, int32_t count,
                       double **values)
{
    YamlNode list = child(reader, map, key);
    if (list == YAML_NO_NODE) return true;
    *values = NEW_ARRAY(double, count, reader->err);
    return *values && read_numbers(reader, list, key, count, *values);
}

// Its length is that of `x`; `y`, `low` and `high` must have the same.
static bool read_series(const PlotReader *reader, YamlNode map, PlotSeries *series)
{
    int32_t marker = MARKER_NONE, line = LINE_SOLID;
    double color = 0;
    if (!check_keys(reader, map, "series", "label x y low high color marker filled line "))
        return false;
    YamlNode x = child(reader, map, "x"), node = child(reader, map, "color");
    if (x == YAML_NO_NODE || child(reader, map, "y") == YAML_NO_NODE) {
        yaml_error(reader->file, map, reader->err, "a series needs its `x` and its `y`");
        return false;
    }
    series->count = yaml_count(reader->file, x);
    if (!read_text(reader, map, "label", series->label, sizeof series->label) ||
        !read_array(reader, map, "x", series->count, &series->x) ||
        !read_array(reader, map, "y", series->count, &series->y) ||
        !read_array(reader, map, "low", series->count, &series->low) ||
        !read_array(reader, map, "high", series->count, &series->high) ||
        !read_choice(reader, map, "marker", MARKERS, &marker) ||
        !read_choice(reader, map, "line", LINES, &line))
        return false;
    if (node != YAML_NO_NODE && !read_number(reader, node, "color", &color)) return false;
    if (!(color >= 0 && color < PLOT_COLORS && color == floor(color)))
        return refuse(reader, node, "color", "a whole number from 0 to 7");
    node = child(reader, map, "filled");
    series->filled = node == YAML_NO_NODE || strcmp(yaml_text(reader->file, node), "false") != 0;
    series->color = (int32_t)color;
    series->marker = (PlotMarker)marker;
    series->line = (PlotLine)line;
    return true;
}

// What stands at y = 1, 2, ...
static bool read_names(const PlotReader *reader, YamlNode list, PlotPanel *panel)
{
    int32_t count = yaml_count(reader->file, list), k = 0;
    if (yaml_kind(reader->file, list) != YAML_LIST || count == 0 || count > PLOT_NAMES_MAX)
        return refuse(reader, list, "names", "a list of at most 100 texts");
    panel->names = memory_array(count, sizeof *panel->names, reader->err);
    if (!panel->names) return false;
    for (YamlNode item = yaml_first(reader->file, list); item != YAML_NO_NODE;
         item = yaml_next(reader->file, item))
        snprintf(panel->names[k++], AXIS_LABEL_SIZE, "%s", yaml_text(reader->file, item));
    panel->y.names = (const char(*)[AXIS_LABEL_SIZE])panel->names;
    panel->y.name_count = count;
    return true;
}

// known: as in check_keys.
static bool read_axis(const PlotReader *reader, YamlNode panel, const char *name, const char *known,
                      Axis *axis)
{
    int32_t scale = 0;
    YamlNode map = child(reader, panel, name);
    *axis = (Axis){.low = NAN, .high = NAN, .factor = 1};
    if (map == YAML_NO_NODE) return true;
    if (!check_keys(reader, map, name, known) ||
        !read_text(reader, map, "label", axis->label, sizeof axis->label) ||
        !read_choice(reader, map, "scale", SCALES, &scale))
        return false;
    axis->is_log = scale == 1;
    YamlNode range = child(reader, map, "range");
    if (range == YAML_NO_NODE) return true;
    double ends[2];
    if (!read_numbers(reader, range, "range", 2, ends)) return false;
    axis->low = ends[0];
    axis->high = ends[1];
    bool good = axis->high > axis->low && (!axis->is_log || axis->low > 0);
    return good ||
           refuse(reader, range, "range", "[low, high], rising, and above 0 on a logarithmic axis");
}

// --- ends of the axes ---------------------------------------------------------------------------

// Takes [count] values into the range `ends`; logarithms on a logarithmic axis, NaN and what it
// cannot show left out.
static void widen(const Axis *axis, const double *values, int32_t count, double ends[2])
{
    for (int32_t k = 0; values && k < count; k++) {
        if (!isfinite(values[k]) || (axis->is_log && values[k] <= 0)) continue;
        double value = axis->is_log ? log10(values[k]) : values[k];
        ends[0] = fmin(ends[0], value);
        ends[1] = fmax(ends[1], value);
    }
}

// Ends that the file does not give: a little beyond the data.
static void fit_axis(const PlotPanel *panel, bool is_x, Axis *axis)
{
    double ends[2] = {INFINITY, -INFINITY};
    bool has_bars = is_x == (panel->y.names != NULL);
    if (isfinite(axis->low)) return;
    if (axis->names) {
        axis->low = 0.5;
        axis->high = axis->name_count + 0.5;
        return;
    }
    for (int32_t k = 0; k < panel->series_count; k++) {
        const PlotSeries *series = &panel->series[k];
        widen(axis, is_x ? series->x : series->y, series->count, ends);
        if (has_bars) widen(axis, series->low, series->count, ends);
        if (has_bars) widen(axis, series->high, series->count, ends);
    }
    if (!(ends[1] >= ends[0])) ends[0] = ends[1] = 0;
    double margin = MARGIN * (ends[1] - ends[0]);
    if (!(margin > 0)) margin = fmax(0.1, 0.1 * fabs(ends[0]));
    axis->low = axis->is_log ? pow(10, ends[0] - margin) : ends[0] - margin;
    axis->high = axis->is_log ? pow(10, ends[1] + margin) : ends[1] + margin;
}

// --- the whole ----------------------------------------------------------------------------------

// An axis with a unit of its own has its prefix; its ends are known.
static bool read_unit(const PlotReader *reader, YamlNode panel, const char *name, Axis *axis)
{
    char unit[UNIT_SIZE] = "", label[AXIS_LABEL_SIZE];
    YamlNode map = child(reader, panel, name);
    if (map == YAML_NO_NODE) return true;
    if (!read_text(reader, map, "unit", unit, sizeof unit)) return false;
    snprintf(label, sizeof label, "%s", axis->label);
    if (unit[0]) axis_set_unit(axis, label, unit);
    return true;
}

// The plot itself, or its inset: both have axes, a legend and series.
static bool read_panel(const PlotReader *reader, YamlNode map, PlotPanel *panel)
{
    YamlNode list = child(reader, map, "series");
    int32_t corner = CORNER_AUTO;
    if (!read_axis(reader, map, "x", "label unit scale range ", &panel->x) ||
        !read_axis(reader, map, "y", "label unit scale range names ", &panel->y) ||
        !read_choice(reader, map, "legend", CORNERS, &corner))
        return false;
    YamlNode y = child(reader, map, "y");
    YamlNode names = y == YAML_NO_NODE ? y : child(reader, y, "names");
    if (names != YAML_NO_NODE && !read_names(reader, names, panel)) return false;
    panel->legend = (PlotCorner)corner;
    if (list == YAML_NO_NODE) {
        yaml_error(reader->file, map, reader->err, "a plot needs `series`");
        return false;
    }
    if (yaml_kind(reader->file, list) != YAML_LIST ||
        yaml_count(reader->file, list) > PLOT_SERIES_MAX)
        return refuse(reader, list, "series", "a list of at most 32 maps");
    for (YamlNode item = yaml_first(reader->file, list); item != YAML_NO_NODE;
         item = yaml_next(reader->file, item))
        if (!read_series(reader, item, &panel->series[panel->series_count++])) return false;
    fit_axis(panel, true, &panel->x);
    fit_axis(panel, false, &panel->y);
    return read_unit(reader, map, "x", &panel->x) && read_unit(reader, map, "y", &panel->y);
}

// Keys are checked here, as an inset has a `place` more than a plot.
static bool read_inset(const PlotReader *reader, YamlNode map, Plot *plot)
{
    YamlNode place = child(reader, map, "place");
    if (!check_keys(reader, map, "inset", "place x y legend series ")) return false;
    if (place == YAML_NO_NODE) {
        yaml_error(reader->file, map, reader->err, "an inset needs its `place`");
        return false;
    }
    plot->has_inset = true;
    if (!read_numbers(reader, place, "place", 4, plot->place)) return false;
    bool good = plot->place[0] >= 0 && plot->place[1] >= 0 && plot->place[2] <= 1 &&
                plot->place[3] <= 1 && plot->place[2] > plot->place[0] &&
                plot->place[3] > plot->place[1];
    if (!good)
        return refuse(reader, place, "place", "[left, top, right, bottom], parts of the frame");
    return read_panel(reader, map, &plot->inset);
}

static bool read_plot(const PlotReader *reader, Plot *plot)
{
    plot->height_over_width = HEIGHT_STANDARD;
    if (!check_keys(reader, YAML_ROOT, "plot", "title height x y legend series inset ") ||
        !read_text(reader, YAML_ROOT, "title", plot->title, sizeof plot->title))
        return false;
    YamlNode height = child(reader, YAML_ROOT, "height"), inset = child(reader, YAML_ROOT, "inset");
    if (height != YAML_NO_NODE && !read_number(reader, height, "height", &plot->height_over_width))
        return false;
    if (!(plot->height_over_width >= 0.3 && plot->height_over_width <= 3))
        return refuse(reader, height, "height", "a number from 0.3 to 3");
    return read_panel(reader, YAML_ROOT, &plot->main) &&
           (inset == YAML_NO_NODE || read_inset(reader, inset, plot));
}

// plot is half filled after a failure: plot_destroy frees it.
bool plot_file_read(const char *path, Plot *plot, Error *err)
{
    PlotReader reader = {.err = err};
    *plot = (Plot){0};
    TRY(yaml_read(path, &reader.file, err));
    TRY(read_plot(&reader, plot));
cleanup:
    yaml_destroy(reader.file);
    return error_is_clean(err);
}

bool plot_bar_ends(const Axes *axes, const PlotSeries *series, int32_t k, Point end[2])
{
    bool lying = axes->y.names != NULL;
    if (!series->low || !series->high) return false;
    double low = series->low[k], high = series->high[k];
    end[0] = lying ? axes_place(axes, low, series->y[k]) : axes_place(axes, series->x[k], low);
    end[1] = lying ? axes_place(axes, high, series->y[k]) : axes_place(axes, series->x[k], high);
    return isfinite(end[0].x + end[0].y + end[1].x + end[1].y);
}

static void panel_destroy(PlotPanel *panel)
{
    memory_free(panel->names);
    for (int32_t k = 0; k < PLOT_SERIES_MAX; k++) {
        memory_free(panel->series[k].x);
        memory_free(panel->series[k].y);
        memory_free(panel->series[k].low);
        memory_free(panel->series[k].high);
    }
}

void plot_destroy(Plot *plot)
{
    panel_destroy(&plot->main);
    panel_destroy(&plot->inset);
    *plot = (Plot){0};
}
