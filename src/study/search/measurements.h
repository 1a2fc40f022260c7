// SPDX-License-Identifier: GPL-2.0-or-later
// Reads measurements: a table whose columns are
//
//     load.pressure, ...       keys of the scene: under which condition
//     mu_M, l_c, ...           results, as `record` of a study names them
//     mu_M_error, ...          one standard deviation of each; a result must have it
//     series/rod_displacement  a series of history.h5, without an error: where it first comes to
//     series/mu                this value another is read, with an error: a curve, a row a point
//
//     hold                     slide-hold-slide: how long the rod was held,
//     mu, healing              the peak of mu when it goes on, or its rise over mu before, with an
//                              error; read off the holds of the run's own program
//
// An empty cell: nothing was measured there. Called by fit.
#ifndef AMONTONS_STUDY_SEARCH_MEASUREMENTS_H
#define AMONTONS_STUDY_SEARCH_MEASUREMENTS_H

#include "study/sweep/computing/point.h"

typedef struct Datum {
    int32_t condition;
    char name[STUDY_NAME_SIZE];   // as the table has it
    char
        along[STUDY_NAME_SIZE];   // of a curve: the series at whose value `at` it is read; "": none
    double at;
    double value, error;   // one standard deviation
} Datum;

typedef struct Measurements {
    int32_t count, room;
    Datum *list;   // [room] owned
    int32_t condition_count, condition_room;
    char **conditions;   // [condition_room] "load.pressure: 0.003, mesh.set.length: 1"; owned
    char **origins;   // [condition_count] file, row and column of each, "measured.csv:3:1"; owned
} Measurements;

// The tables that `fit: measured` names, seen from the study.
bool measurements_read(const Study *study, Measurements *measured, Error *err);
void measurements_destroy(Measurements *measured);   // zeroed is fine

// Finds the result of a run in its run.json, and for a curve in the history.h5 beside it. *value:
// NaN: the run has none. *error: one standard deviation of the computed value, half of how far it
// is known; 0: not known, as for curves.
bool measurements_find(const Datum *datum, const char *report, const char *history, double *value,
                       double *error, Error *err);

// The whole curve that such a datum lies on, of a run: both series [*count], the caller's
// (memory_free), also after a failure.
bool measurements_curve(const Datum *datum, const char *history, double **x, double **y,
                        int64_t *count, Error *err);

#endif
