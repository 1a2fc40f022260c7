// SPDX-License-Identifier: GPL-2.0-or-later
// The file is read key by key; what is given twice, unknown or of the wrong kind is refused with
// its place. Ends of the axes that the file leaves open are found last: a little beyond the data of
// all panels, and at the outer edges of a map's cells.
#include "render/plot/plot_file.h"

#include "base/memory.h"
#include "base/system.h"
#include "io/files/folder.h"
#include "io/hdf5/array_file.h"
#include "io/text/yaml_document.h"
#include "render/picture_options.h"
#include "render/plot/map_cells.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { UNIT_SIZE = 16 };

static const double HEIGHT_STANDARD = 0.75;

static const char *const MARKERS[] = {"none", "circle", "square", "triangle",
                                      "down", "cross",  NULL};
static const char *const LINES[] = {"none", "solid", "thin", "dashed", NULL};
static const char *const LEGENDS[] = {"below", "none", NULL};
static const char *const SCALES[] = {"linear", "log", NULL};

typedef struct PlotReader {
    YamlDocument *file;   // owned
    const char *path;   // of the file: names of tables are seen from its folder
    const char *root;   // the path's beginning, inside of which all tables must lie; NULL: anywhere
    Error *err;
} PlotReader;

// --- values ------------------------------------------------------------------------------------

// Always false, as yaml_refuse.
static bool refuse(const PlotReader *reader, YamlNode node, const char *what, const char *allowed)
{
    return yaml_refuse(reader->file, node, what, allowed, reader->err);
}

// The child of `map` called `key`; YAML_NO_NODE: there is none.
static YamlNode child(const PlotReader *reader, YamlNode map, const char *key)
{
    YAML_EACH (item, reader->file, map)
        if (strcmp(yaml_key(reader->file, item), key) == 0) return item;
    return YAML_NO_NODE;
}

// A key that is in none of the `known` names, each with a space behind it, is refused.
static bool check_keys(const PlotReader *reader, YamlNode map, const char *what, const char *known)
{
    if (yaml_kind(reader->file, map) != YAML_MAP) return refuse(reader, map, what, "a map of keys");
    YAML_EACH (item, reader->file, map) {
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

// The result keeps its value where the key is missing, as in all that follow. names: NULL at the
// end.
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

// Reads a list of exactly `wanted` numbers.
static bool read_numbers(const PlotReader *reader, YamlNode list, const char *what, int32_t wanted,
                         double *values)
{
    int32_t k = 0;
    bool good = yaml_kind(reader->file, list) == YAML_LIST &&
                yaml_count(reader->file, list) == wanted;
    char allowed[60];
    snprintf(allowed, sizeof allowed, "a list of %d numbers", wanted);
    if (!good) return refuse(reader, list, what, allowed);
    YAML_EACH (item, reader->file, list)
        if (!read_number(reader, item, what, &values[k++])) return false;
    return true;
}

// Checks that a file that the plot names may be opened; `path` is that of the plot's folder and the
// name, or the name where it is absolute.
static bool check_place(const PlotReader *reader, const char *path, Error *err)
{
    if (!reader->root) return true;
    size_t length = strlen(reader->root);
    bool below = strncmp(path, reader->root, length) == 0 && path[length] == '/';
    return folder_check_inside(reader->root, below ? path + length + 1 : path, err);
}

// The column of a table: "../sweep.h5:result/mu_M", as seen from the plot's folder.
static bool read_column(const PlotReader *reader, const char *place, int32_t *count,
                        double **values)
{
    Error *err = reader->err, closing = {0};
    const char *slash = strrchr(reader->path, '/'), *colon = strrchr(place, ':');
    int folder = slash && place[0] != '/' ? (int)(slash - reader->path) + 1 : 0;
    char path[PATH_MAX];
    int64_t rows = 0;
    int32_t width = 0;
    ArrayFile *file = NULL;
    if (snprintf(path, sizeof path, "%.*s%.*s", folder, reader->path, (int)(colon - place),
                 place) >= (int)sizeof path)
        FAIL(err, ERROR_INPUT, "the path of a table is too long");
    TRY(check_place(reader, path, err));
    TRY(file = array_file_open(path, err));
    TRY(array_file_read(file, colon + 1, values, &rows, &width, err));
    if (width != 1 || rows > INT32_MAX || (*count >= 0 && rows != *count))
        FAIL(err, ERROR_INPUT, "%s: `%s` does not hold one column of as many numbers as the others",
             path, colon + 1);
    *count = (int32_t)rows;
cleanup:
    array_file_close(file, error_is_clean(err) ? err : &closing);
    return error_is_clean(err);
}

// A list of numbers, or FILE.h5:NAME: *values is [*count], the caller's; NULL where the key is
// missing. *count not negative: exactly so many are wanted.
static bool read_array(const PlotReader *reader, YamlNode map, const char *key, int32_t *count,
                       double **values)
{
    YamlNode node = child(reader, map, key);
    if (node == YAML_NO_NODE) return true;
    const char *text = yaml_text(reader->file, node);
    if (yaml_kind(reader->file, node) == YAML_SCALAR && strstr(text, ".h5:"))
        return read_column(reader, text, count, values);
    int32_t wanted = *count >= 0 ? *count : yaml_count(reader->file, node);
    *values = NEW_ARRAY(double, wanted, reader->err);
    *count = wanted;
    return *values && read_numbers(reader, node, key, wanted, *values);
}

// --- parts of a plot -----------------------------------------------------------------------------

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
    series->count = -1;
    if (!read_text(reader, map, "label", series->label, sizeof series->label) ||
        !read_array(reader, map, "x", &series->count, &series->x) ||
        !read_array(reader, map, "y", &series->count, &series->y) ||
        !read_array(reader, map, "low", &series->count, &series->low) ||
        !read_array(reader, map, "high", &series->count, &series->high) ||
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

// Reads the data of a panel; each part may be missing.
static bool read_data(const PlotReader *reader, YamlNode map, PlotPanel *panel)
{
    YamlNode list = child(reader, map, "series"), colors = child(reader, map, "map");
    if (colors != YAML_NO_NODE) {
        PlotMap *data = &panel->map;
        if (!check_keys(reader, colors, "map", "x y value contour open ")) return false;
        panel->has_map = true;
        data->count = -1;
        if (!read_array(reader, colors, "x", &data->count, &data->x) ||
            !read_array(reader, colors, "y", &data->count, &data->y) ||
            !read_array(reader, colors, "value", &data->count, &data->value) ||
            !read_array(reader, colors, "contour", &data->count, &data->contour) ||
            !read_array(reader, colors, "open", &data->count, &data->open))
            return false;
        if (!data->x || !data->y || !data->value) {
            yaml_error(reader->file, colors, reader->err, "a map needs its `x`, `y` and `value`");
            return false;
        }
    }
    if (list == YAML_NO_NODE) return true;
    if (yaml_kind(reader->file, list) != YAML_LIST ||
        yaml_count(reader->file, list) > PLOT_SERIES_MAX)
        return refuse(reader, list, "series", "a list of at most 32 maps");
    YAML_EACH (item, reader->file, list)
        if (!read_series(reader, item, &panel->series[panel->series_count++])) return false;
    return true;
}

// The plot itself, or its inset: both have axes and what they show.
static bool read_panel(const PlotReader *reader, YamlNode map, PlotPanel *panel)
{
    if (!read_axis(reader, map, "x", "label unit column scale range ", &panel->x) ||
        !read_axis(reader, map, "y", "label unit column scale range names ", &panel->y))
        return false;
    YamlNode y = child(reader, map, "y");
    YamlNode names = y == YAML_NO_NODE ? y : child(reader, y, "names");
    if (names != YAML_NO_NODE) {
        // They stand at y = 1, 2, ...
        int32_t count = yaml_count(reader->file, names), k = 0;
        if (yaml_kind(reader->file, names) != YAML_LIST || count == 0 || count > PLOT_NAMES_MAX)
            return refuse(reader, names, "names", "a list of at most 100 texts");
        panel->names = memory_array(count, sizeof *panel->names, reader->err);
        if (!panel->names) return false;
        YAML_EACH (item, reader->file, names)
            snprintf(panel->names[k++], AXIS_LABEL_SIZE, "%s", yaml_text(reader->file, item));
        panel->y.names = (const char(*)[AXIS_LABEL_SIZE])panel->names;
        panel->y.name_count = count;
    }
    bool shows = child(reader, map, "series") != YAML_NO_NODE ||
                 child(reader, map, "map") != YAML_NO_NODE ||
                 child(reader, map, "panels") != YAML_NO_NODE;
    if (!shows) {
        yaml_error(reader->file, map, reader->err, "a plot needs `series`, `map` or `panels`");
        return false;
    }
    return read_data(reader, map, panel);
}

static bool read_panels(const PlotReader *reader, YamlNode list, Plot *plot)
{
    int32_t count = yaml_count(reader->file, list);
    if (yaml_kind(reader->file, list) != YAML_LIST || count == 0 || count > PLOT_PANELS_MAX)
        return refuse(reader, list, "panels", "a list of at most 24 maps");
    plot->panels = NEW_ARRAY(PlotPanel, count, reader->err);
    if (!plot->panels) return false;
    YAML_EACH (item, reader->file, list) {
        PlotPanel *panel = &plot->panels[plot->panel_count++];
        if (!check_keys(reader, item, "panels", "title series map ") ||
            !read_text(reader, item, "title", panel->title, sizeof panel->title) ||
            !read_data(reader, item, panel))
            return false;
    }
    return true;
}

// Keys are checked here, as an inset has a `place` more than a plot.
static bool read_inset(const PlotReader *reader, YamlNode map, Plot *plot)
{
    YamlNode place = child(reader, map, "place");
    if (!check_keys(reader, map, "inset", "place x y series map ")) return false;
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

// Options as the command has them; those that it is given go before these.
static bool read_page(const PlotReader *reader, Plot *plot)
{
    YamlNode map = child(reader, YAML_ROOT, "page");
    if (map == YAML_NO_NODE) return true;
    if (yaml_kind(reader->file, map) != YAML_MAP || yaml_count(reader->file, map) > PLOT_WORDS)
        return refuse(reader, map, "page", "a map of options, as {style: columns}");
    YAML_EACH (item, reader->file, map) {
        Error why = {0};
        char *word = plot->words[plot->word_count++];

        // A file is named as seen from the plot's folder.
        const char *text = yaml_text(reader->file, item), *slash = strrchr(reader->path, '/');
        bool measured = strcmp(yaml_key(reader->file, item), "compare") == 0;
        bool beside = measured && text[0] != '/' && slash;
        if (system_is_descriptor(text))
            return refuse(
                reader, item, "page",
                "a file by its own path: what is open already may be named on the command "
                "line alone");
        snprintf(word, PLOT_WORD_SIZE, "%.*s%s", beside ? (int)(slash - reader->path) + 1 : 0,
                 reader->path, text);

        if (measured && !check_place(reader, word, &why)) {
            // Measurements lie where their user has them, and PICTURE-compared.csv, which was
            // written with the picture, has the same ones.
            char file[PLOT_WORD_SIZE];
            const char *dot = strrchr(reader->path, '.');
            int length = snprintf(file, sizeof file, "%.*s-compared.csv",
                                  dot > slash ? (int)(dot - reader->path) : 0, reader->path);
            error_clear(&why);
            if (length >= (int)sizeof file || access(file, R_OK) != 0 ||
                !check_place(reader, file, &why)) {
                plot->left_out = word;
                continue;
            }
            snprintf(plot->measured, sizeof plot->measured, "%s", strrchr(word, '/') + 1);
            memcpy(word, file, (size_t)length + 1);
        }
        if (picture_option_set(&plot->style, yaml_key(reader->file, item), word, &why)) continue;
        yaml_error(reader->file, item, reader->err, "page: %s", why.message);
        return false;
    }
    return true;
}

static bool read_plot(const PlotReader *reader, Plot *plot)
{
    static const char known[] =
        "title height x y color contours legend series map panels inset page ";
    static const char *const axes[2] = {"x", "y"};
    int32_t legend = 0;
    YamlNode height = child(reader, YAML_ROOT, "height");
    YamlNode inset = child(reader, YAML_ROOT, "inset");
    YamlNode panels = child(reader, YAML_ROOT, "panels");
    if (!check_keys(reader, YAML_ROOT, "plot", known) ||
        !read_text(reader, YAML_ROOT, "title", plot->title, sizeof plot->title) ||
        !read_choice(reader, YAML_ROOT, "legend", LEGENDS, &legend))
        return false;
    plot->no_legend = legend == 1;
    plot->height_over_width = HEIGHT_STANDARD;
    if (height != YAML_NO_NODE) {
        if (!read_number(reader, height, "height", &plot->height_over_width)) return false;
        if (!(plot->height_over_width >= 0.3 && plot->height_over_width <= 3))
            return refuse(reader, height, "height", "a number from 0.3 to 3");
    }
    if (!read_axis(reader, YAML_ROOT, "color", "label unit range ", &plot->color) ||
        !read_axis(reader, YAML_ROOT, "contours", "label unit ", &plot->contours) ||
        !read_page(reader, plot) || !read_panel(reader, YAML_ROOT, &plot->main))
        return false;
    if (panels != YAML_NO_NODE && !read_panels(reader, panels, plot)) return false;

    // The names of columns are asked of the plot as a whole: panels share its axes.
    for (int32_t k = 0; k < 2; ++k) {
        YamlNode axis = child(reader, YAML_ROOT, axes[k]);
        if (axis != YAML_NO_NODE &&
            !read_text(reader, axis, "column", plot->column[k], PLOT_LABEL_SIZE))
            return false;
    }
    return inset == YAML_NO_NODE || read_inset(reader, inset, plot);
}

// --- ends of the axes ---------------------------------------------------------------------------

static const double MARGIN = 0.05;   // of the data's range, beside the data

// Range of data in the scale of an axis: logarithms on a logarithmic one.
typedef struct Ends {
    double low, high;   // of marks and lines: a margin goes beside them
    double edge_low, edge_high;   // of cells: none
} Ends;

// NaN and what the axis cannot show are left out.
static void widen(const Axis *axis, const double *values, int32_t count, Ends *ends)
{
    for (int32_t k = 0; values && k < count; k++) {
        if (!isfinite(values[k]) || (axis->is_log && values[k] <= 0)) continue;
        double value = axis->is_log ? log10(values[k]) : values[k];
        ends->low = fmin(ends->low, value);
        ends->high = fmax(ends->high, value);
    }
}

// axes: x and y, of which one is looked for.
static bool widen_by_panel(const PlotPanel *panel, const Axis axes[2], int32_t which, Ends *ends,
                           Error *err)
{
    const PlotMap *map = &panel->map;
    bool has_bars = which == (axes[1].names ? 0 : 1);
    for (int32_t k = 0; k < panel->series_count; k++) {
        const PlotSeries *series = &panel->series[k];
        widen(&axes[which], which ? series->y : series->x, series->count, ends);
        if (has_bars) widen(&axes[which], series->low, series->count, ends);
        if (has_bars) widen(&axes[which], series->high, series->count, ends);
    }
    if (!panel->has_map) return true;
    MapGrid grid = {0};
    bool done = map_grid_find(map, axes[0].is_log, axes[1].is_log, &grid, err);
    if (done && grid.columns > 0) {
        ends->edge_low = fmin(ends->edge_low, which ? grid.y[0] : grid.x[0]);
        ends->edge_high = fmax(ends->edge_high, which ? grid.y[grid.rows] : grid.x[grid.columns]);
    } else if (done) {
        widen(&axes[which], which ? map->y : map->x, map->count, ends);
    }
    map_grid_destroy(&grid);
    return done;
}

// panels: those that share the axes of `panel`, [count]; none for an inset.
static bool fit_axes(PlotPanel *panel, const PlotPanel *panels, int32_t count, Error *err)
{
    Axis axes[2] = {panel->x, panel->y}, *both[2] = {&panel->x, &panel->y};
    for (int32_t which = 0; which < 2; which++) {
        Ends ends = {INFINITY, -INFINITY, INFINITY, -INFINITY};
        Axis *axis = both[which];
        if (isfinite(axis->low)) continue;
        if (axis->names) {
            axis->low = 0.5;
            axis->high = axis->name_count + 0.5;
            continue;
        }
        if (!widen_by_panel(panel, axes, which, &ends, err)) return false;
        for (int32_t k = 0; k < count; k++)
            if (!widen_by_panel(&panels[k], axes, which, &ends, err)) return false;
        double low = ends.low, high = ends.high;
        if (!(high >= low) && !(ends.edge_high > ends.edge_low)) low = high = 0;
        if (high >= low) {
            double margin = MARGIN * (high - low);
            if (!(margin > 0)) margin = fmax(0.1, 0.1 * fabs(low));
            low -= margin;
            high += margin;
        }
        low = fmin(low, ends.edge_low);
        high = fmax(high, ends.edge_high);
        axis->low = axis->is_log ? pow(10, low) : low;
        axis->high = axis->is_log ? pow(10, high) : high;
    }
    return true;
}

// Least and largest of a quantity of all maps: their values, or what their lines show. They are the
// ends of its axis, unless the file gives these.
static void fit_values(const Plot *plot, bool of_contours, Axis *axis, double found[2])
{
    const Axis plain = {0};
    Ends ends = {INFINITY, -INFINITY, 0, 0};
    for (int32_t k = -1; k < plot->panel_count; k++) {
        const PlotMap *map = k < 0 ? &plot->main.map : &plot->panels[k].map;
        widen(&plain, of_contours ? map->contour : map->value, map->count, &ends);
    }
    found[0] = ends.low <= ends.high ? ends.low : 0;
    found[1] = ends.low <= ends.high ? ends.high : 0;
    if (isfinite(axis->low)) return;
    axis->low = found[0];
    axis->high = found[1];
}

// Ranks, numbers of pads: all that stands along an axis are whole numbers.
static bool is_counted(const Plot *plot, bool along_x)
{
    const Axis *axis = along_x ? &plot->main.x : &plot->main.y;
    if (axis->is_log || axis->factor != 1 || !(axis->high - axis->low >= 1)) return false;
    for (int32_t p = -1; p < plot->panel_count; ++p) {
        const PlotPanel *panel = p < 0 ? &plot->main : &plot->panels[p];
        const PlotMap *map = &panel->map;
        for (int32_t s = 0; s < panel->series_count; ++s) {
            const PlotSeries *series = &panel->series[s];
            const double *values = along_x ? series->x : series->y;
            for (int32_t k = 0; k < series->count; ++k)
                if (isfinite(values[k]) && values[k] != floor(values[k])) return false;
        }
        for (int32_t k = 0; panel->has_map && k < map->count; ++k) {
            double value = (along_x ? map->x : map->y)[k];
            if (isfinite(value) && value != floor(value)) return false;
        }
    }
    return true;
}

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

// plot is half filled after a failure: plot_destroy frees it.
static bool read_file(const char *path, const char *root, Plot *plot, Error *err)
{
    PlotReader reader = {.path = path, .root = root, .err = err};
    *plot = (Plot){0};
    TRY(yaml_read(path, &reader.file, err));
    TRY(read_plot(&reader, plot));
    double levels[2];
    fit_values(plot, false, &plot->color, plot->found);
    fit_values(plot, true, &plot->contours, levels);
    TRY(fit_axes(&plot->main, plot->panels, plot->panel_count, err));
    if (plot->has_inset) TRY(fit_axes(&plot->inset, NULL, 0, err));
    plot->main.x.whole = is_counted(plot, true);
    plot->main.y.whole = is_counted(plot, false);

    // Units have the prefix that suits the ends, which are known now.
    YamlNode inset = child(&reader, YAML_ROOT, "inset");
    TRY(read_unit(&reader, YAML_ROOT, "x", &plot->main.x) &&
        read_unit(&reader, YAML_ROOT, "y", &plot->main.y) &&
        read_unit(&reader, YAML_ROOT, "color", &plot->color) &&
        read_unit(&reader, YAML_ROOT, "contours", &plot->contours) &&
        (inset == YAML_NO_NODE || (read_unit(&reader, inset, "x", &plot->inset.x) &&
                                   read_unit(&reader, inset, "y", &plot->inset.y))));
cleanup:
    yaml_destroy(reader.file);
    return error_is_clean(err);
}

bool plot_file_read(const char *path, Plot *plot, Error *err)
{
    return read_file(path, NULL, plot, err);
}

bool plot_file_read_inside(const char *root, const char *name, Plot *plot, Error *err)
{
    char path[PATH_MAX];
    *plot = (Plot){0};
    if (snprintf(path, sizeof path, "%s/%s", root, name) >= (int)sizeof path)
        return REFUSE(err, "the path of a plot is too long");
    return folder_check_inside(root, name, err) && read_file(path, root, plot, err);
}

static void panel_destroy(PlotPanel *panel)
{
    memory_free_all(panel->names, panel->map.x, panel->map.y, panel->map.value, panel->map.contour,
                    panel->map.open);
    for (int32_t k = 0; k < PLOT_SERIES_MAX; k++) {
        memory_free_all(panel->series[k].x, panel->series[k].y, panel->series[k].low,
                        panel->series[k].high);
    }
}

void plot_destroy(Plot *plot)
{
    panel_destroy(&plot->main);
    panel_destroy(&plot->inset);
    for (int32_t k = 0; k < plot->panel_count; k++) panel_destroy(&plot->panels[k]);
    memory_free_all(plot->panels, plot->computed);
    *plot = (Plot){0};
}
