// SPDX-License-Identifier: GPL-2.0-or-later
// The table of a sweep, a row a point in the study's order: sweep.csv and sweep.h5.
#ifndef AMONTONS_STUDY_SWEEP_SHOWING_TABLE_H
#define AMONTONS_STUDY_SWEEP_SHOWING_TABLE_H

#include "study/sweep/computing/point.h"
#include "study/sweep/showing/warned.h"
#include "study/sweep/showing/words.h"

enum { TABLE_PATH_SIZE = STUDY_NAME_SIZE + 16 };

typedef struct TableColumn {
    char name[TABLE_PATH_SIZE], path[TABLE_PATH_SIZE];   // in the table; of a result in run.json
    const char *group, *description;   // in sweep.h5; static storage, or the study's
    int32_t of;   // the column of the result beside which run.json has it; -1: none
    double *values;   // [points] NaN where there is none; owned, like the next
    WordList words;   // where a value is a word, it is the word's index
} TableColumn;

typedef struct SweepTable {
    int32_t count;
    TableColumn
        *columns;   // [count] keys that vary, what is recorded, each with what stands beside
    // it in run.json, and the next three; owned
    TableColumn *status;   // a PointStatus
    TableColumn *warnings;   // all of a run in one text; the first word is "": none
    TableColumn *doubtful;   // 1: the point has a warning or lacks what is ranked or drawn
    // Columns of the study's records: the value, and what run.json has as NAME_error and
    // NAME_known_to beside it; -1: nothing.
    int32_t value[STUDY_RECORDS_MAX], error[STUDY_RECORDS_MAX], known_to[STUDY_RECORDS_MAX];
    Warned warned;   // also of points without the result that is ranked or drawn; owned
    bool is_si;   // scenes have units of SI
    int32_t no_bar;   // points whose mesh leaves an error that is not known
} SweepTable;

bool table_write(const Sweep *sweep, SweepTable *table, Error *err);
// Value of a record at a point, its error, and how far it is known: that is the error if run.json
// does not say what a mesh usually leaves. If both are equal, the error is an error bar.
double table_value(const SweepTable *table, int32_t record, int32_t point);
double table_error(const SweepTable *table, int32_t record, int32_t point);
double table_known_to(const SweepTable *table, int32_t record, int32_t point);
void table_destroy(SweepTable *table);   // zeroed is fine

#endif
