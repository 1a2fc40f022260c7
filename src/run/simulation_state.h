// SPDX-License-Identifier: GPL-2.0-or-later
// State that the stages of a simulation share. run/simulation is the list of stages; amontons.h
// declares the part that the caller sees.
#ifndef AMONTONS_RUN_SIMULATION_STATE_H
#define AMONTONS_RUN_SIMULATION_STATE_H

#include "amontons.h"
#include "amontons_simulation.h"
#include "answers/error_bars.h"
#include "base/hash.h"
#include "base/memory.h"
#include "model/model.h"
#include "record/contact_arrays.h"
#include "record/fields.h"
#include "record/history.h"
#include "record/pads.h"
#include "record/program_readings.h"
#include "record/rotation.h"
#include "record/steady.h"
#include "record/window.h"
#include "run/result/result_folder.h"
#include "stepping/explicit_reference.h"

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

struct Simulation {
    Scene scene;
    RunOptions options;
    ResultFolder folder;
    Model model;   // of `scene`
    Friction friction;   // that acts now: the model's, or none while relaxing without friction
    Rod rod;   // where it is and what it does now; owned
    RodCourse rod_course;   // how it is driven, where the scene has a program
    LoadCourse load_course;
    int64_t relaxation_steps;
    StepControl control;
    ExplicitReference explicit_reference;   // empty under another scheme
    int64_t explicit_steps;   // of it in a recording interval
    Observation seen;   // the last accepted step
    Events events;
    Drops drops;
    Steady steady;
    Pads pads;
    ContactArrays contact;
    Rotation rotation;
    ProgramReadings readings;   // empty where the rod never jumps
    History history;
    Probes probes;   // read by it
    Fields fields;
    Recorders recorders;
    Window window;   // part of the run that is written; one of the recorders where it is given
    double
        *block_motion;   // [nodes * 4] displacement, velocity of the mesh; NULL: not asked; owned
    double t_end;   // time; INFINITY: the rod no longer goes where the scene ends
    double pressure;   // that acts now, stress
    bool mu_above, mu_fell;   // time.until.mu_below: mu has been above it; and has fallen below
    RunTiming timing;
    RunErrors errors;
    RunWarnings warnings;
    bool ill_posed;   // or not resolved: the run was warned that steps may not close the ledger
    const Levels *levels;   // several meshes and runs, of which this is one; NULL: it is alone
    char identity[HASH_TEXT_SIZE];   // of scene, bulk and interface; empty: not asked for yet
    bool closed;   // simulation_finish has been called
    bool goes_on;   // from a checkpoint
    int32_t resumed;   // so many times since t = 0
    bool checkpoint_failed;   // and the run was warned of it
    double checkpoint_at, checkpoint_cost;   // wall clock of the last one; how long it took, s
    double last_unquiet;   // when slip was last rapid or not certified, time
    double started;   // wall clock, s
    double deadline;   // of it, when the run ends as if it were stopped; INFINITY: never
    int64_t allocations_before;   // simulation_allocations() when the time loop began
    int32_t figures;   // drawn
};

// Arrays allocated so far, but for those of levels.
static inline int64_t simulation_allocations(const Simulation *simulation)
{
    return memory_counters().allocations - simulation->control.dt_levels.allocations;
}

// These functions make up amontons_run and run/accuracy, beside the pieces in amontons.h.
bool simulation_run(const Scene *scene, const RunOptions *options, RunSummary *summary, Error *err);
bool simulation_create_by(const Scene *scene, const RunOptions *options, double deadline,
                          Simulation **simulation, Error *err);
bool simulation_loop(Simulation *simulation, Error *err);   // steps to the end of the scene

// ERROR_INTERRUPT: the caller wants a stop, or the time is up. Asked between phases and steps.
bool simulation_may_go_on(const Simulation *simulation, Error *err);
bool steering_is_open(const Simulation *simulation, Error *err);   // ERROR_INPUT: finished
bool simulation_is_finished(const Simulation *simulation);   // the scene's end, or its period
Answers simulation_answers(const Simulation *simulation);   // of this run so far, at its end
// Time when rod or load next come to a point of the scene's programs; INFINITY: never.
double steering_next_point(const Simulation *simulation);
// Is called after a step: where it has reached `point` waves are resolved again.
void steering_pass_point(Simulation *simulation, double point);
double steering_end(const Simulation *simulation);   // when the scene ends, as the rod moves now

// Closes history, draws, reports. failure: NULL, or why the run ended early; it is reported, and
// what was computed is kept.
bool simulation_finish(Simulation *simulation, const Error *failure, RunSummary *summary,
                       Error *err);
// Destroys; where `err` is set what was computed is reported first. simulation NULL is fine.
void simulation_end(Simulation *simulation, RunSummary *summary, const Error *err);

#endif
