// SPDX-License-Identifier: GPL-2.0-or-later
// What the readings of a run come to (record/program_readings): a, a - b and the slip distance by
// all velocity steps, and healing per decade of time held, by a straight line: its error is the
// standard error of the line, and what the errors of the healings can do to its slope. Called by
// run/report and run/summary.
#ifndef AMONTONS_RECORD_PROGRAM_RESULTS_H
#define AMONTONS_RECORD_PROGRAM_RESULTS_H

#include "io/text/json_writer.h"
#include "record/program_readings.h"

// A bar holds those of all velocity steps in which they are known; NaN: none.
typedef struct ProgramSums {
    int32_t steps, holds;
    Estimate direct, change;   // per ln(V2/V1)
    Estimate distance, healing;   // length; per decade of time held
} ProgramSums;

ProgramSums program_results_sum(const ProgramReadings *readings);
void program_results_json(const ProgramReadings *readings, JsonWriter *json);   // results.program

#endif
