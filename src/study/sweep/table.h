// SPDX-License-Identifier: GPL-2.0-or-later
// The table of a sweep, a row a point in the study's order: sweep.csv and sweep.h5.
#ifndef AMONTONS_STUDY_SWEEP_TABLE_H
#define AMONTONS_STUDY_SWEEP_TABLE_H

#include "study/sweep/point.h"

enum { WORDS_MAX = 64, WORD_SIZE = 64 };

// Words in a column of keys that are no numbers; the table holds their index.
typedef struct WordList {
    int32_t count;
    char words[WORDS_MAX][WORD_SIZE];
} WordList;

// What is known of a coefficient of friction at each point; NaN: nothing. [point_count] each.
typedef struct Bounds {
    double *low, *high;   // owned, like the next
    double *period;   // its values repeat after so many slidings; 0: they do not
} Bounds;

// The numbers of the table, column after column; NaN where there is none.
typedef struct SweepTable {
    double *keys;   // [column_count][point_count]; owned, like all below
    double *records;   // [record_count][point_count]
    double *status;   // [point_count] a PointStatus
    Bounds mu_M, mu_hold;
    WordList *words;   // [column_count]
} SweepTable;

bool table_write(const Sweep *sweep, SweepTable *table, Error *err);
// Whether the values of `record` repeat, and their bounds: those of mu_hold for itself, those of
// mu_M for all other columns. *bounded: low and high are bounds of this column.
const Bounds *table_bounds(const SweepTable *table, const StudyRecord *record, bool *bounded);
void table_destroy(SweepTable *table);   // zeroed is fine

#endif
