// SPDX-License-Identifier: GPL-2.0-or-later
// Results from the readings of a run (record/program_readings): a, a - b and the slip distance from
// all velocity steps, and healing per decade of time held, from a straight line. The error of the
// healing combines the standard error of the line and the change of slope that the errors of the
// readings allow. Called by run/report and run/summary.
#ifndef AMONTONS_ANSWERS_PROGRAM_RESULTS_H
#define AMONTONS_ANSWERS_PROGRAM_RESULTS_H

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
