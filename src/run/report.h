// SPDX-License-Identifier: GPL-2.0-or-later
// run.json: what was asked, what was done, what came out with which errors. One object,
// written last, atomically.
#ifndef AMONTONS_RUN_REPORT_H
#define AMONTONS_RUN_REPORT_H

#include "amontons.h"
#include "model/model.h"
#include "record/error_bars.h"
#include "record/pads.h"
#include "record/program_readings.h"
#include "record/steady.h"
#include "record/turning.h"

// The largest of each kind of error over a run's accepted steps, relative (record/observation).
typedef struct RunErrors {
    double energy, complementarity, moment, equation;
    double penetration;   // of a contact node into the plane, length
    double reduction;   // of the interface operator, measured when the basis was built, at the
        // steps that were accepted (reduction/reduction); 0: full mesh
    double moment_quasi_static;   // without inertia, over frames in which nothing is fast
} RunErrors;

typedef struct RunTiming {
    double relax, solve, output, total;   // s; the model keeps what it took to make it
    double outside;   // processor time of the process outside relaxation and time loop: what it
        // takes to begin, and to report at the end, s
} RunTiming;

// Nothing is owned.
typedef struct RunReport {
    const Scene *scene;
    const Error *failure;   // NULL: done
    const RunCounters *counters;
    const Ladder *ladder;   // NULL: the run never came to it
    const RunTiming *timing;
    const Model *model;
    int64_t relaxation_steps;
    int32_t resumed;   // so many times gone on from a checkpoint
    const RunErrors *errors;
    const Events *events;
    const Drops *drops;
    const Answers *answers;
    const Event *least_resolved;   // before which the fewest cells slipped; NULL: none
    const Steady *steady;
    const Pads *pads;
    const Turning *turning;
    const ProgramReadings *readings;
    const Levels *levels;   // NULL: one run
    const RunWarnings *warnings;
} RunReport;

bool report_write(const char *folder, const RunReport *report, Error *err);
// The same in memory (memory_free); NULL on failure. Paths in it are as seen from `folder`.
char *report_text(const char *folder, const RunReport *report, Error *err);

#endif
