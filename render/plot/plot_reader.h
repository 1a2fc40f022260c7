// SPDX-License-Identifier: GPL-2.0-or-later
// Values of a plot file: texts, numbers, choices, arrays. What is of the wrong kind is refused with
// its place. Called by plot_file.
#ifndef AMONTONS_RENDER_PLOT_PLOT_READER_H
#define AMONTONS_RENDER_PLOT_PLOT_READER_H

#include "io/text/yaml_document.h"

#include <stdbool.h>
#include <stddef.h>

typedef struct PlotReader {
    YamlDocument *file;   // owned
    const char *path;   // of the file: names of tables are seen from its folder
    Error *err;
} PlotReader;

// Always false, as yaml_refuse.
bool plot_refuse(const PlotReader *reader, YamlNode node, const char *what, const char *allowed);
// The child of `map` called `key`; YAML_NO_NODE: there is none.
YamlNode plot_child(const PlotReader *reader, YamlNode map, const char *key);
// A key that is in none of the `known` names, each with a space behind it, is refused.
bool plot_check_keys(const PlotReader *reader, YamlNode map, const char *what, const char *known);

// The result keeps its value where the key is missing. names: NULL at the end.
bool plot_read_choice(const PlotReader *reader, YamlNode map, const char *key,
                      const char *const *names, int32_t *choice);
bool plot_read_text(const PlotReader *reader, YamlNode map, const char *key, char *text,
                    size_t size);
// null is NaN.
bool plot_read_number(const PlotReader *reader, YamlNode node, const char *what, double *value);
// Reads a list of exactly `wanted` numbers.
bool plot_read_numbers(const PlotReader *reader, YamlNode list, const char *what, int32_t wanted,
                       double *values);
// A list of numbers, or FILE.h5:NAME: *values is [*count], the caller's; NULL where the key is
// missing. *count not negative: exactly so many are wanted.
bool plot_read_array(const PlotReader *reader, YamlNode map, const char *key, int32_t *count,
                     double **values);

#endif
