// SPDX-License-Identifier: GPL-2.0-or-later
// run.json: what was asked, what was done, what came out and how far it can be trusted. One object,
// written last, atomically. Keys that DESIGN section 5 names keep their names.
#ifndef AMONTONS_RUN_REPORT_H
#define AMONTONS_RUN_REPORT_H

#include "amontons.h"
#include "record/falls.h"
#include "record/peaks.h"
#include "scene/scene.h"

// The largest of each kind of error over a run's accepted steps, relative (record/observation).
typedef struct RunErrors {
    double energy, complementarity, moment, equation;
    double penetration;   // of a contact node into the plane, length
    double reduction;   // of the interface operator, measured when the basis was built, at the
        // steps that were accepted (bulk/reduction); 0: full mesh
    double moment_quasi_static;   // without inertia, over frames in which nothing is fast
} RunErrors;

typedef struct RunTiming {
    double mesh, reduce, relax, solve, output, total;   // s
    double outside;   // processor time of the process outside relaxation and time loop: what it
        // takes to begin, and to report at the end, s
} RunTiming;

typedef struct RunModel {
    int32_t contact_nodes, rod_nodes, full_dofs, reduced_dofs, elements;
    double length, height;
    WaveSpeeds speeds;   // elastic, of the material
    int64_t relaxation_steps;
    bool from_cache;   // the basis was: nothing of the full mesh was factored
} RunModel;

// Nothing is owned.
typedef struct RunReport {
    const Scene *scene;
    const Error *failure;   // NULL: done
    const RunCounters *counters;
    const Ladder *ladder;   // NULL: the run never came to it
    const RunTiming *timing;
    const RunModel *model;
    const RunErrors *errors;
    const Peaks *peaks;
    const Pads *pads;
    const Falls *falls;
    const PeaksSummary *summary;
    const Events *events;
    const RunWarnings *warnings;
    const char *cache_note;   // empty: nothing to say
} RunReport;

bool report_write(const char *folder, const RunReport *report, Error *err);

#endif
