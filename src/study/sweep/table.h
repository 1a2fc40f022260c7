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

// The numbers of the table, column after column; NaN where there is none.
typedef struct SweepTable {
    double *keys;   // [column_count][point_count]; owned, like all below
    double *records;   // [record_count][point_count]
    double *status;   // [point_count] a PointStatus
    double *period;   // [point_count] of peaks or, ranked by them, of falls; 0: none
    double *low, *high;   // [point_count] bounds of mu_M: of its own peaks where they are
        // periodic, of all peaks but the first where not; ranked by mu_trusted: bounds of that
    WordList *words;   // [column_count]
} SweepTable;

bool table_write(const Sweep *sweep, SweepTable *table, Error *err);
void table_destroy(SweepTable *table);   // zeroed is fine

#endif
