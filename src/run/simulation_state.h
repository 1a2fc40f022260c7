// SPDX-License-Identifier: GPL-2.0-or-later
// State that the stages of a simulation share, and the stages. run/simulation is the list of them;
// amontons.h declares the part that the caller sees.
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
#include "record/observation.h"
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
    // Set at the end (simulation_finish), for run.json and the caller alike.
    Answers answers;   // by all levels, where there are several
    RunCounters counters;
    const Event *least_resolved;   // before which the fewest cells slipped, of `events`; NULL: none
};

// Arrays allocated so far, but for those of levels.
static inline int64_t simulation_allocations(const Simulation *simulation)
{
    return memory_counters().allocations - simulation->control.dt_levels.allocations;
}

// --- stages, in the order in which run/simulation calls them ------------------------------------

// From a model that stands to t = 0 (run/start): step control, relaxation, the rod in place, after
// which rod and load follow the scene's programs, explicit steps.
bool start_prepare_steps(Simulation *simulation, Error *err);
void start_programs(Simulation *simulation);
bool start_relax(Simulation *simulation, Error *err);
// Puts the explicit scheme in the place of step control: central differences on the full mesh
// (stepping/explicit_reference). Does nothing for an implicit scheme. Called after relaxing, which
// is implicit for both schemes: at the explicit step it would take longer than many a run, and so
// both start from one state of rest.
//
// The step is the longest stable one (stepping/stable_step), or time.step_max where that is
// shorter, shortened so that a whole number of steps makes a recording interval. Recorders see such
// an interval as one step, so that a benchmark does not measure the recording, and while slip is
// rapid as many states as with implicit steps. Parts that only implicit steps have (step-size
// levels, error control) stand still. RunCounters.accepted counts the explicit steps, and
// run.json's `step_sizes` has one entry, the explicit step size.
bool start_explicit_steps(Simulation *simulation, Error *err);

// Changes between steps, and how far the run goes (run/steering).
bool steering_is_open(const Simulation *simulation, Error *err);   // ERROR_INPUT: finished
// ERROR_INTERRUPT: the caller wants a stop, or the time is up. Asked between phases and steps.
bool simulation_may_go_on(const Simulation *simulation, Error *err);
// Time when rod or load next come to a point of the scene's programs; INFINITY: never.
double steering_next_point(const Simulation *simulation);
// Is called after a step: where it has reached `point` waves are resolved again.
void steering_pass_point(Simulation *simulation, double point);
double steering_end(const Simulation *simulation);   // when the scene ends, as the rod moves now

// RESULT/checkpoint.bin (run/checkpoint): a saved state that a run goes on from. Written now and
// then, where a run is stopped, and at its end; first all steps of the history are put on the disk,
// so that it goes at least as far.
//
// Reads the checkpoint of `folder`. ERROR_INPUT: there is none.
bool checkpoint_read(const char *folder, SavedState *state, Error *err);
// Checks that the history of `folder` is that of the checkpoint. ERROR_INPUT: it is another one.
bool checkpoint_check_history(const char *folder, const HistoryEnd *end, Error *err);
// Is called after each step. A checkpoint that cannot be written is a warning: the run goes on.
void checkpoint_when_due(Simulation *simulation);
bool checkpoint_is_kept(const Simulation *simulation);   // this run writes any
bool checkpoint_now(Simulation *simulation, Error *err);
// A finished result that has a history may be gone on with; others need none.
bool checkpoint_at_end(Simulation *simulation, Error *err);

typedef struct SavedHead {
    double time;   // the state's
    HistoryEnd history;   // the one written so far
} SavedHead;

// The simulation may be restored from `state` (run/saved_state; amontons_simulation.h saves and
// restores): its checksum holds, and it was saved by a build of these sources from this scene, mesh
// and basis. ERROR_INPUT, nothing is changed: which of these is not so.
bool saved_state_fits(Simulation *simulation, const SavedState *state, SavedHead *head, Error *err);

// Output that a scene asks for, opened as recorders or drawn at the end (run/output).
bool output_check(const Scene *scene, Error *err);   // that this build can write it
bool output_open(Simulation *simulation, Error *err);   // history and fields
// With the first step, and what was recorded so far on the disk, an earlier result may go.
bool output_begin_result(Simulation *simulation, Error *err);
void output_warn_of_window(Simulation *simulation);   // where nothing lay in it
bool output_store_warnings(Simulation *simulation, Error *err);   // before the history's finish
bool output_draw_figures(Simulation *simulation, Error *err);   // from the finished history

// Error that the mesh of one run leaves, as far as this run tells it (run/one_mesh). Sets how far
// the answers of this run alone are known.
void one_mesh_answer(const Simulation *simulation, Answers *answers);
// Contact nodes, and whether cells are too long for slip: for runs behind an error bar.
void one_mesh_read(const Simulation *simulation, Level *level);

// Increase of mu by the last nodes of the contact. Slow slip grows from the trailing end; where its
// front comes to the last nodes of the leading end before the block slides, these hold the block
// while mu rises. The rise depends on their size: shorter cells let go sooner
// (validation/paper/README.md). The rise from when the front comes to them until the block slides
// is an error of the mesh. In space a row of nodes lets go one by one, and bars hold without this
// (validation/space/priors.md). Watched after each step.
//
// Zeroed before the first step, but for mu and passed: NaN.
typedef struct EndWait {
    double mu;   // when the front came to the last nodes, since the last fall; NaN: it has not
    double passed;   // when it had come past them
    double rise;   // sum over bulk slidings
    int32_t slidings;   // all but the first
} EndWait;

void end_wait_watch(EndWait *wait, const Simulation *simulation);
// Mean rise of mu, where the front of slip comes to the last nodes (critical_length: the mean l_c,
// length) and the block slides as soon as it comes past them. 0: it does not; several pads; in
// space.
double end_wait_of(const EndWait *wait, const Interface *interface, double critical_length);

// Data for the caller of amontons.h (run/summary): of an accepted step (also of study/line's;
// t_end: when the scene ends, time), and at the end counts, answers and seconds.
StepView step_view(const Observation *seen, const Events *events, const ContactArrays *contact,
                   double t_end);
RunCounters summary_count(const Simulation *simulation);
void summary_fill(const Simulation *simulation, RunSummary *summary);   // once it has answers

// run.json (run/report): what was asked, what was done, what came out with which errors. One
// object, written last, atomically. failure: why the run ended early; NULL: it is done.
bool report_write(const Simulation *simulation, const Error *failure, const char *folder,
                  Error *err);
// The same in memory (memory_free); NULL on failure. Paths in it are as seen from `folder`.
char *report_text(const Simulation *simulation, const Error *failure, const char *folder,
                  Error *err);

// --- the run, as amontons_run and run/accuracy call it, beside the pieces in amontons.h ---------

bool simulation_run(const Scene *scene, const RunOptions *options, RunSummary *summary, Error *err);
bool simulation_create_by(const Scene *scene, const RunOptions *options, double deadline,
                          Simulation **simulation, Error *err);
bool simulation_loop(Simulation *simulation, Error *err);   // steps to the end of the scene
Answers simulation_answers(const Simulation *simulation);   // of this run so far, at its end

// Closes history, draws, reports. failure: NULL, or why the run ended early; it is reported, and
// what was computed is kept.
bool simulation_finish(Simulation *simulation, const Error *failure, RunSummary *summary,
                       Error *err);
// Destroys; where `err` is set what was computed is reported first. simulation NULL is fine.
void simulation_end(Simulation *simulation, RunSummary *summary, const Error *err);

#endif
