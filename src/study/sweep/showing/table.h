// SPDX-License-Identifier: GPL-2.0-or-later
// The table of a sweep, a row a point in the study's order: sweep.csv and sweep.h5.
#ifndef AMONTONS_STUDY_SWEEP_SHOWING_TABLE_H
#define AMONTONS_STUDY_SWEEP_SHOWING_TABLE_H

#include "study/sweep/computing/point.h"
#include "study/sweep/showing/warned.h"
#include "study/sweep/showing/words.h"

// The numbers of the table, column after column; NaN where there is none.
typedef struct SweepTable {
    double *keys;   // [column_count][point_count]; owned, like all below
    double *records;   // [record_count][point_count]
    double *errors;   // of the records, alike: what run.json has as NAME_error beside them
    double *known_to;   // alike: NAME_known_to
    double *status;   // [point_count] a PointStatus
    double *warnings;   // [point_count] index in warning_words
    bool has_error[STUDY_RECORDS_MAX];   // run.json has an error beside this record
    bool has_known_to[STUDY_RECORDS_MAX];
    int32_t column_count;
    WordList *words;   // [column_count] where a key has words, the table has their index
    WordList warning_words;   // the first is "": no warning
    Warned warned;   // also of points without the result that is ranked or drawn
    bool is_si;   // scenes have units of SI
    int32_t no_bar;   // points whose mesh leaves an error that is not known
} SweepTable;

bool table_write(const Sweep *sweep, SweepTable *table, Error *err);
// The values of a record, [point_count], and how far they are known: their errors, where run.json
// does not tell what a mesh usually leaves. Where both are alike it is an error bar.
const double *table_values(const Sweep *sweep, const SweepTable *table, int32_t record);
const double *table_errors(const Sweep *sweep, const SweepTable *table, int32_t record);
const double *table_known_to(const Sweep *sweep, const SweepTable *table, int32_t record);
void table_destroy(SweepTable *table);   // zeroed is fine

#endif
