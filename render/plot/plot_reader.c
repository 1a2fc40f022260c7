// SPDX-License-Identifier: GPL-2.0-or-later
#include "render/plot/plot_reader.h"

#include "base/memory.h"
#include "io/hdf5/array_file.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

bool plot_refuse(const PlotReader *reader, YamlNode node, const char *what, const char *allowed)
{
    return yaml_refuse(reader->file, node, what, allowed, reader->err);
}

YamlNode plot_child(const PlotReader *reader, YamlNode map, const char *key)
{
    YAML_EACH (item, reader->file, map)
        if (strcmp(yaml_key(reader->file, item), key) == 0) return item;
    return YAML_NO_NODE;
}

bool plot_check_keys(const PlotReader *reader, YamlNode map, const char *what, const char *known)
{
    if (yaml_kind(reader->file, map) != YAML_MAP)
        return plot_refuse(reader, map, what, "a map of keys");
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

bool plot_read_choice(const PlotReader *reader, YamlNode map, const char *key,
                      const char *const *names, int32_t *choice)
{
    char allowed[200] = "";
    YamlNode node = plot_child(reader, map, key);
    if (node == YAML_NO_NODE) return true;
    for (int32_t k = 0; names[k]; k++) {
        size_t used = strlen(allowed);
        snprintf(allowed + used, sizeof allowed - used, "%s%s", k ? ", " : "", names[k]);
        if (strcmp(yaml_text(reader->file, node), names[k]) != 0) continue;
        *choice = k;
        return true;
    }
    return plot_refuse(reader, node, key, allowed);
}

bool plot_read_text(const PlotReader *reader, YamlNode map, const char *key, char *text,
                    size_t size)
{
    YamlNode node = plot_child(reader, map, key);
    if (node == YAML_NO_NODE) return true;
    const char *given = yaml_text(reader->file, node);
    if (yaml_kind(reader->file, node) != YAML_SCALAR || strlen(given) >= size)
        return plot_refuse(reader, node, key, "a text, not too long");
    memcpy(text, given, strlen(given) + 1);
    return true;
}

bool plot_read_number(const PlotReader *reader, YamlNode node, const char *what, double *value)
{
    char *end = NULL;
    const char *text = yaml_text(reader->file, node);
    *value = NAN;
    if (yaml_kind(reader->file, node) == YAML_NOTHING) return true;
    *value = strtod(text, &end);
    if (yaml_kind(reader->file, node) == YAML_SCALAR && *text && !*end && isfinite(*value))
        return true;
    return plot_refuse(reader, node, what, "a number, or null");
}

bool plot_read_numbers(const PlotReader *reader, YamlNode list, const char *what, int32_t wanted,
                       double *values)
{
    int32_t k = 0;
    bool good = yaml_kind(reader->file, list) == YAML_LIST &&
                yaml_count(reader->file, list) == wanted;
    char allowed[60];
    snprintf(allowed, sizeof allowed, "a list of %d numbers", wanted);
    if (!good) return plot_refuse(reader, list, what, allowed);
    YAML_EACH (item, reader->file, list)
        if (!plot_read_number(reader, item, what, &values[k++])) return false;
    return true;
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

bool plot_read_array(const PlotReader *reader, YamlNode map, const char *key, int32_t *count,
                     double **values)
{
    YamlNode node = plot_child(reader, map, key);
    if (node == YAML_NO_NODE) return true;
    const char *text = yaml_text(reader->file, node);
    if (yaml_kind(reader->file, node) == YAML_SCALAR && strstr(text, ".h5:"))
        return read_column(reader, text, count, values);
    int32_t wanted = *count >= 0 ? *count : yaml_count(reader->file, node);
    *values = NEW_ARRAY(double, wanted, reader->err);
    *count = wanted;
    return *values && plot_read_numbers(reader, node, key, wanted, *values);
}
