// SPDX-License-Identifier: GPL-2.0-or-later
// The stored table of a sweep, sweep.h5, as plots need it: columns by name, formulas over them, and
// which points are doubtful. Called by sweep_plot.
#ifndef AMONTONS_STUDY_SWEEP_SHOWING_PLOT_TABLE_H
#define AMONTONS_STUDY_SWEEP_SHOWING_PLOT_TABLE_H

#include "amontons.h"
#include "io/hdf5/array_file.h"
#include "study/sweep/reading/study.h"
#include "study/sweep/showing/quantity_label.h"
#include "study/sweep/showing/words.h"

enum { PLOT_COLUMNS_MAX = 64 };

// A column of the table, or what a formula makes of some.
typedef struct Quantity {
    QuantityLabel label;
    bool is_key;   // of the scene
    double *values;   // [count of the table]; owned, as the next two
    double *errors;   // [count], NULL: none are known
    WordList words;   // of a key with words: values are indices
} Quantity;

typedef struct PlotTable {
    char title[PLOT_FOLDER_SIZE];   // the study's, or else the folder's name
    int32_t count;   // points
    bool is_si;
    double *warned;   // [count] 0: the point has no warning; owned
    ArrayFile *file;   // owned
    char path[AMONTONS_PATH_SIZE];
    int32_t column_count;   // read so far
    char names[PLOT_COLUMNS_MAX][STUDY_NAME_SIZE];
    Quantity columns[PLOT_COLUMNS_MAX];
} PlotTable;

// ERROR_INPUT: `folder` holds no finished sweep of this version.
bool plot_table_open(const char *folder, PlotTable *table, Error *err);
void plot_table_close(PlotTable *table);   // zeroed is fine

// A column's name, or "= a formula". The result is the table's where it is a column (`made` stays
// empty), else *made. ERROR_INPUT: there is no such column.
const Quantity *plot_table_find(PlotTable *table, const char *text, Quantity *made, Error *err);
void quantity_destroy(Quantity *quantity);   // zeroed is fine

#endif
