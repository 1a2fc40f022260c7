// SPDX-License-Identifier: GPL-2.0-or-later
#include "study/sweep/reading/plot_words.h"

#include "study/sweep/reading/wanted_keys.h"

#include <ctype.h>
#include <stdio.h>
#include <string.h>

enum { KEY_LOG = PLOT_KEYS, KEY_NAME, KEY_WITH, KEY_COMPARE, KEYS };

static const char *const NAMES[KEYS] = {"x",      "y",   "color", "contours", "series",
                                        "panels", "log", "name",  "with",     "compare"};

const char *plot_key_name(PlotKey key)
{
    return NAMES[key];
}

// text: [size], kept where the key is missing.
static bool read_text(const YamlDocument *file, const WantedKey *key, char *text, size_t size,
                      Error *err)
{
    if (key->node == YAML_NO_NODE) return true;
    const char *given = yaml_text(file, key->node);
    if (!*given || strlen(given) >= size)
        return yaml_refuse(file, key->node, key->name, "a name or a formula, not too long", err);
    memcpy(text, given, strlen(given) + 1);
    return true;
}

// It becomes the name of a file.
static bool read_name(const YamlDocument *file, const WantedKey *key, StudyPlot *plot, Error *err)
{
    bool good = true;
    snprintf(plot->name, sizeof plot->name, "%s", plot->text[PLOT_COLOR][0] ? "map" : "plot");
    if (!read_text(file, key, plot->name, sizeof plot->name, err)) return false;
    for (const char *at = plot->name; *at; at++)
        good = good && (isalnum((unsigned char)*at) || *at == '-' || *at == '_');
    if (!good || strcmp(plot->name, "ranking") == 0)
        return yaml_refuse(file, key->node, "name",
                           "a name of letters, digits, - and _, but not `ranking`", err);
    return error_is_clean(err);
}

// One folder, or a list of them.
static bool read_with(const YamlDocument *file, const WantedKey *key, StudyPlot *plot, Error *err)
{
    if (key->node == YAML_NO_NODE) return true;
    bool is_list = yaml_kind(file, key->node) == YAML_LIST;
    YamlNode item = is_list ? yaml_first(file, key->node) : key->node;
    for (; item != YAML_NO_NODE; item = is_list ? yaml_next(file, item) : YAML_NO_NODE) {
        WantedKey one = {key->name, item};
        if (plot->with_count == PLOT_WITH_MAX)
            return yaml_refuse(file, item, "with", "at most 6 folders of sweeps", err);
        if (!read_text(file, &one, plot->with[plot->with_count++], PLOT_FOLDER_SIZE, err))
            return false;
    }
    return true;
}

static bool check_together(const YamlDocument *file, YamlNode map, const StudyPlot *plot,
                           Error *err)
{
    bool is_map = plot->text[PLOT_COLOR][0];
    for (PlotKey key = PLOT_X; key <= PLOT_Y; key++) {
        if (plot->text[key][0]) continue;
        return yaml_error(file, map, err,
                          "plot: `%s` must be given, as in {x: load.pressure, y: mu_M}",
                          NAMES[key]);
    }
    if (is_map && plot->text[PLOT_SERIES][0])
        yaml_error(file, plot->node[PLOT_SERIES], err,
                   "series: a map has none; `panels` draws one for each value of a key");
    if (!is_map && plot->text[PLOT_CONTOURS][0])
        yaml_error(file, plot->node[PLOT_CONTOURS], err,
                   "contours: only a map has them, which needs `color`");
    if (is_map && plot->compare[0])
        yaml_error(file, map, err, "compare: measurements are drawn over curves, not over a map");
    return error_is_clean(err);
}

bool plot_words_read(const YamlDocument *file, YamlNode map, StudyPlot *plot, Error *err)
{
    static const char *const logs[] = {"none", "x", "y", "both"};
    WantedKey keys[KEYS];
    int32_t log = 0;
    *plot = (StudyPlot){0};
    for (int32_t k = 0; k < KEYS; k++) keys[k] = (WantedKey){.name = NAMES[k]};
    if (!wanted_find(file, map, "plot", keys, KEYS, err)) return false;
    for (int32_t k = 0; k < PLOT_KEYS; k++) {
        plot->node[k] = keys[k].node;
        if (!read_text(file, &keys[k], plot->text[k], PLOT_TEXT_SIZE, err)) return false;
    }
    if (!wanted_choice(file, &keys[KEY_LOG], logs, 4, &log, err)) return false;
    plot->log_given = keys[KEY_LOG].node != YAML_NO_NODE;
    plot->log_x = log == 1 || log == 3;
    plot->log_y = log == 2 || log == 3;
    return read_name(file, &keys[KEY_NAME], plot, err) &&
           read_with(file, &keys[KEY_WITH], plot, err) &&
           read_text(file, &keys[KEY_COMPARE], plot->compare, PLOT_FOLDER_SIZE, err) &&
           check_together(file, map, plot, err);
}
