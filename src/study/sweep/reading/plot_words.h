// SPDX-License-Identifier: GPL-2.0-or-later
// Reads a study's `plot`, or that of `amontons render --plot`, which says what a plot shows:
//
//     {x: load.pressure, y: mu_M, series: mesh.set.length, log: x}          curves
//     {x: load.pressure, y: mesh.set.length, color: mu_M, contours: l_c}    a map
//     {x: load.pressure, y: mu_M, compare: measured.csv}    beside measurements
//
// Each quantity is a column of the sweep's table, or a formula over columns that begins with `=`.
#ifndef AMONTONS_STUDY_SWEEP_READING_PLOT_WORDS_H
#define AMONTONS_STUDY_SWEEP_READING_PLOT_WORDS_H

#include "io/text/yaml_document.h"

enum { STUDY_NAME_SIZE = 96, PLOT_TEXT_SIZE = 200, PLOT_FOLDER_SIZE = 512, PLOT_WITH_MAX = 6 };

typedef enum PlotKey {
    PLOT_X,
    PLOT_Y,
    PLOT_COLOR,   // given: the plot is a map
    PLOT_CONTOURS,
    PLOT_SERIES,   // a key: a curve for each of its values
    PLOT_PANELS,   // a key: a panel for each of its values
    PLOT_KEYS,
} PlotKey;

typedef struct StudyPlot {
    char name[STUDY_NAME_SIZE];   // of its files
    char text[PLOT_KEYS][PLOT_TEXT_SIZE];   // empty: not given
    YamlNode node[PLOT_KEYS];   // where it stands
    bool log_given, log_x, log_y;
    int32_t with_count;
    char with[PLOT_WITH_MAX][PLOT_FOLDER_SIZE];   // other sweeps to show beside: their folders, as
        // seen from the file's, or from the working folder where there is none
    char compare[PLOT_FOLDER_SIZE];   // a table of measurements, seen likewise; empty: none
} StudyPlot;

const char *plot_key_name(PlotKey key);   // "x"; static storage

// Does not check what the names stand for.
bool plot_words_read(const YamlDocument *file, YamlNode map, StudyPlot *plot, Error *err);

#endif
