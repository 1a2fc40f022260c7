// SPDX-License-Identifier: GPL-2.0-or-later
// The public header of amontons: when and how an elastic block starts to slide. The command line
// includes nothing else of ours but those beside it: amontons_stability.h (growth rates),
// amontons_model1d.h (the 1D model); amontons_simulation.h is for callers who step by themselves.
//
//   Error err = {0};
//   Scene *scene = NULL;
//   RunOptions options = {.folder = "result"};
//   RunSummary summary;
//   bool done = amontons_scene_read("scene.yaml", NULL, 0, &scene, &err) &&
//               amontons_run(scene, &options, &summary, &err);
//   amontons_scene_destroy(scene);
//
// Functions that can fail return bool (true: done) and take an Error last, handed in clean. Strings
// and arrays handed in stay the caller's. Quantities are in the units of the scene's file.
// The library never prints, exits, or changes locale and signals of the process. Simulations may
// be computed in several threads at a time, each in one.
#ifndef AMONTONS_H
#define AMONTONS_H

#include "amontons_error.h"
#include "amontons_pictures.h"
#include "amontons_words.h"

#include <signal.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>

#ifdef __cplusplus
extern "C" {
#endif

typedef struct Scene Scene;   // what to compute; opaque here

enum { AMONTONS_PATH_SIZE = 1024 };

// weakens: slips, and friction falls with the slip rate
enum { NODE_OPEN, NODE_STICKS, NODE_WEAKENS, NODE_SLIPS };

// The contact nodes. The arrays belong to the simulation, stay where they are, and hold the last
// accepted step.
typedef struct ContactView {
    int32_t count;   // contact nodes
    int32_t tangents;   // of slip: 1, along x; in space 2, and y; fastest of [count][tangents]
    const double *x, *y;   // [count] position, x ascending; y: across the drive, NULL in the plane
    const double *slip_rate;   // [count][tangents] velocity
    const double *slip;   // [count][tangents] since t = 0, length
    const double *pressure;   // [count] stress
    const double *shear;   // [count][tangents] positive where the floor drags the block back
    const uint8_t *status;   // [count] NODE_...
    const double *state;   // [count][states] of friction that remembers; NULL: it does not
    int32_t states;   // of a node
} ContactView;

// One accepted step, as shown to the caller.
typedef struct StepView {
    double t, U;   // time, 0 when the rod starts; displacement of its drive, length
    double rod_way, mu;   // of the rod itself, length (U: rod.stiffness is not given); F_T / F_N
    double step_size;   // of this step, time
    double front;   // l, how far slip has grown from the trailing edge, length
    double max_slip_rate;   // largest |slip rate| on the interface, velocity
    double fraction;   // of the way to `time.until`, 0 to 1
    bool certified;   // the slip set cannot grow on its own: large steps are allowed
    int32_t events, slidings;   // seen so far: rapid ones; those that crossed the interface
    int32_t mesh, run;   // of those behind an error bar, from 1; 0: the scene itself
    double mu_M, mu_hold, seconds_left;   // of such a run: so far; of accuracy.within; NaN: none
    ContactView contact;
} StepView;

// Counts of the work that was done: a benchmark prints these, run.json holds them.
typedef struct RunCounters {
    int64_t accepted;   // steps
    int64_t rejected;   // steps undone by error control or by the certificate
    int64_t rejected_uncertified;   // of these: a large step that led to an uncertified state
    int64_t stepped_over_oscillations;   // accepted steps over those of slow slip that stay small
    int64_t unsolved_retries;   // steps undone because the contact problem was not solved
    int64_t factorisations, solves;   // sparse; a solve is forward plus backward
    int64_t contact_solves, contact_iterations;   // contact problems, two a step; over all
    int64_t contact_fallbacks;   // contact problems that the plain iteration did not settle
    int64_t contact_rescued;   // of these: solved after sweeps only
    int64_t certificates;   // factorisations to judge states
    int64_t loop_allocations;   // arrays allocated in the time loop (0 but levels of dt, output)
} RunCounters;

enum { RUN_WARNINGS_MAX = 8, RUN_WARNING_SIZE = 400, MESH_MOVED_SIZE = 160 };
typedef struct RunWarnings {   // what makes an answer doubtful, a sentence each
    int32_t count;
    char text[RUN_WARNINGS_MAX][RUN_WARNING_SIZE];
} RunWarnings;

// Results of a run, for the closing lines; run.json holds more.
typedef struct RunSummary {
    // Answers, as answers/answers.h defines them: macroscopic static friction coefficient, holding
    // coefficient, the largest mu. NaN: the block did not slide; the load did not drop.
    double mu_M, mu_hold, mu_max, mu_steady;   // mu_steady: at which it slides at the end; NaN
    double mu_M_error, mu_hold_error;   // bars of 95 %, of the parts that are known; NaN: none is
    double mu_M_parts[3], mu_hold_parts[3];   // of the bars: mesh, branches, drops; NaN: not known
    double mu_M_known_to, mu_hold_known_to, mu_max_known_to;   // NaN: cells are too long
    // Error bar (accuracy.mu): its runs, its meshes, and the contact nodes of the last mesh.
    int32_t bar_runs, bar_meshes, bar_nodes;
    double bar_wanted, bar_window;   // over mu; of pressures, relative
    bool bar_goes_on;   // its runs go on where time.until would have ended the scene's own
    double bar_own_mu_M;   // of the scene's own run alone, to which the bar does not belong; NaN
    const char *bar_ended, *mu_M_is;   // why no more runs; results.mu_M_is of run.json; both static
    double mu_M_spread;   // largest less smallest of the peaks in mu_M; NaN: fewer than two
    int32_t peaks, peaks_counted, period;   // seen; in mu_M; they repeat after so many, or 0
    int32_t drops, drop_period;   // load drops in mu_hold; they repeat after so many, 0: not
    bool drops_enough;   // and repeat, or the mean of 30 and more is known to 2 %
    const char *run_in;   // why run-in is not over (static storage); NULL: it is
    double run_in_drift, run_in_drops_left;   // of mu a drop, relative; for so many more; NaN
    int32_t quasi_static, bounded, leading, slight;   // events by kind; slight: no precursors
    // First loading, up to the first sliding of the whole block (results.first): the largest mu and
    // where it was, NaN: it did not slide; l_c / L; precursors before it. Beside it means over the
    // later cycles that count: precursors in each, NaN: there is none; length of the longest / L.
    double first_mu, first_U, first_critical_length, first_longest;
    double first_mu_error, first_mu_known_to;
    int32_t first_precursors;
    double later_precursors, later_longest;
    double normal_force;   // F_N of the whole block, force; NaN: in the plane without `thickness`
    double base_slip;   // mean slip over a base that deforms, over the contact's length; NaN: rigid
    double critical_length;   // l_c / L seen in the dynamics; NaN: none
    // Length and number of cells that slipped where slow slip turned fast, of the load drop that
    // counts and has the fewest cells; NaN: none. slip_pad: the pad; empty: a contact in one piece.
    double slip_length, slip_cells;
    char slip_pad[64];
    // Names in the order in which pads let go before the last sliding of the whole block, "left,
    // middle with right"; empty: there was none, or the contact is one piece.
    char pads_order[200], pads_order_first[200];   // the other: before the first sliding
    // Results of a program whose velocity jumps (results.program): value and error; NaN: not known.
    int32_t velocity_steps, holds;
    double direct_effect[2], level_change[2];   // per ln(V2/V1)
    double slip_distance[2], healing[2];   // length; per decade of time held
    double energy_error, moment_error, complementarity_error;   // the largest, relative
    double seconds_solve, seconds_output, seconds_total;   // wall time
    RunCounters counters;
    char mesh_moved[MESH_MOVED_SIZE];   // how the mesh was scaled and moved; empty: not at all
    int32_t field_files, figures;   // VTU files written, pictures drawn
    RunWarnings warnings;   // also where the run failed
    char folder[AMONTONS_PATH_SIZE];   // where everything lies
} RunSummary;

// Mesh whose runs are done, of a scene that asks for an error bar (accuracy.mu).
typedef struct LevelView {
    int32_t level, contact_nodes, runs;   // level: 1, 2, ...
    const char *answer;   // "mu_M", or "mu_hold" where the block does not slide as a whole
    double value, bar, known_to;   // NaN: none; the bar, or what one mesh alone usually leaves
    double mesh;   // its part of the bar; NaN: first level
    double seconds, seconds_next;   // wall time; expected of the next mesh, NaN: not known
} LevelView;
typedef void (*LevelCallback)(const LevelView *view, void *context);
// Called after every accepted step (run) on the thread of the run. Must not keep `view`.
typedef void (*StepCallback)(const StepView *view, void *context);
// Called when "meshing", "reducing" or "relaxing" begins. Static storage.
typedef void (*StageCallback)(const char *stage, void *context);
typedef void (*ReportCallback)(const char *json, void *context);   // json: during the call

typedef struct RunOptions {
    const char *folder;   // the result folder, created; NULL: nothing is written at all
    bool overwrite;   // replace an earlier result in it (else ERROR_INPUT)
    bool resume;   // go on with the result in it from its checkpoint.bin (none fits: ERROR_INPUT)
    double checkpoint_every;   // between two checkpoints, wall time, s; 0: 10, below 0: none
    StepCallback on_step;   // NULL: none
    LevelCallback on_level;   // NULL: none
    StageCallback on_stage;   // NULL: none
    ReportCallback on_report;   // what run.json holds, also where nothing is written; NULL: none
    void *context;   // handed to these
    // Non-zero: finish the step, keep what is there, return ERROR_INTERRUPT; NULL: never.
    const volatile sig_atomic_t *stop;
    bool whole_block;   // amontons_simulation_block will be called: the mesh is made, also where
        // the cache could do without
} RunOptions;

// --- the library --------------------------------------------------------------------------------
const char *amontons_version(void);   // "0.3.0"; static storage, like the next two
// Revision in git, "3c94c86f0d", with ", changed" behind it if there were changes that were not
// committed; "": built from an archive.
const char *amontons_revision(void);
const char *amontons_libraries(void);   // what it was built with: "gmsh 4.8.0, HDF5 1.10.8, ..."
// OpenBLAS's kernels in use, "Haswell"; *possible: those that the processor could run, NULL: these.
// Where it is not NULL, start your process with OPENBLAS_CORETYPE set to it: products are up to 5
// times as fast then, and rounded as those of the program are.
const char *amontons_kernels(const char **possible);
// true: files that may be damaged or a stranger's are read in child processes (fork) from now on,
// as the program does; call it before there are other threads. false, as at the start: in this
// process. Where the user has set the variable AMONTONS_APART that decides: empty means false.
void amontons_use_child_processes(bool use);
// The folder of the meshes and example scenes that come with the library; false: not found.
bool amontons_data_folder(char folder[AMONTONS_PATH_SIZE]);

// --- scenes -------------------------------------------------------------------------------------
// Reads `path` and applies `overrides` ("load.pressure=0.006"), [override_count]. ERROR_INPUT gives
// file:line:column or the override, the key, what was found and what is allowed.
bool amontons_scene_read(const char *path, const char *const *overrides, int32_t override_count,
                         Scene **scene, Error *err);
// The same of a scene that you know: its .geo may run commands, write files and open others, its
// friction law may be a plug-in (--trust). Elsewhere these are refused.
bool amontons_scene_read_trusted(const char *path, const char *const *overrides,
                                 int32_t override_count, Scene **scene, Error *err);
void amontons_scene_destroy(Scene *scene);   // NULL is fine
const char *amontons_scene_title(const Scene *scene);   // owned by the scene
bool amontons_scene_is_si(const Scene *scene);   // else its numbers are normalised
const char *amontons_scene_warning(const Scene *scene);   // NULL: none; static storage
bool amontons_scene_reference(FILE *out, Error *err);   // every key, as Markdown

// --- one simulation -----------------------------------------------------------------------------
// Everything: mesh, relax, time loop, results, pictures, run.json. On failure what was computed
// stays in the folder and run.json says why. A scene with accuracy.mu is run on meshes of falling
// cell size until its error bar is met; results are those of the last mesh.
bool amontons_run(const Scene *scene, const RunOptions *options, RunSummary *summary, Error *err);

// --- statics ------------------------------------------------------------------------------------
// Equilibrium under the scene's load, rod displacement and supports; friction is Coulomb's with
// mu_static, stick is relative to the undeformed block. Forces are per width, in space forces.
typedef struct StaticSummary {
    int32_t dim, nodes, contact_nodes, rod_nodes, open, sticking, slipping;   // contact nodes that
    double normal_force, shear_force;   // of the plane on the block, along z and x
    double pressure_moment;   // sum of x r_n
    double rod_force, rod_height;   // of the rod along x; z of its resultant (NaN: no force)
    double elastic_energy, load_work;   // u'Ku/2 and f'u
    double residual;   // largest out-of-balance nodal force ...
    double force_balance, moment_balance;   // ... and of the sums, relative to the largest force
    double energy_balance;   // |u'Ku - f'u - r'u|, relative
    double complementarity;   // largest violation of the contact conditions, relative
    int64_t iterations;   // of the contact solver
} StaticSummary;
// Writes static.{json,h5,vtu} into `folder` (NULL: nothing). ERROR_COMPUTE: found no equilibrium.
bool amontons_static(const Scene *scene, const char *folder, bool overwrite, StaticSummary *summary,
                     Error *err);

// --- sweeps -------------------------------------------------------------------------------------
// One point that ended, or was found finished.
typedef struct SweepView {
    int32_t point;   // from 0, in the order of the table
    const char *words;   // "load.pressure=0.003 ..."
    const char *message;   // why it failed; NULL: it did not
    const char *run;   // its run.json; NULL: it left none (`keep: table`)
    double mu_M, mu_M_error;   // NaN: none
    const char *quantity;   // what the study ranks by, "mu_hold"; else "mu_M"
    double value, bar, known_to;   // of it; bar: with the mesh's part; NaN: none
    bool warned, reused;   // its run.json has warnings; it is from an earlier sweep
    double seconds, seconds_left;   // of this point; for the whole, estimated (NaN: not yet)
    int32_t finished, failed, points;   // so far, among them, and in all
} SweepView;
typedef void (*SweepCallback)(const SweepView *view, void *context);
typedef struct SweepOptions {
    const char *folder;   // for sweep.csv, sweep.h5 and points/; created
    const char *const *overrides;   // "key=value", for every point
    int32_t override_count;
    int32_t jobs;   // processes at a time; 0: as many as there are cores
    const char *slurm;   // by jobs of Slurm: more words for sbatch, or ""; NULL: here
    bool retry;   // compute failed points again
    bool fresh;   // compute all points again
    bool trust;   // of its scenes, as amontons_scene_read_trusted
    SweepCallback on_point;   // NULL: none
    void *context;
    FILE *out;   // for the ranked table that the study asks for; NULL: not shown
    const volatile sig_atomic_t *stop;   // non-zero: stop the points under way; they count as not
        // begun when the sweep is taken up again
} SweepOptions;
typedef struct SweepSummary {
    int32_t points, computed, reused, failed, pending;
    double seconds;
} SweepSummary;

// Computes the points of the study file `path`, in processes of their own, and writes the table.
// Points that are finished in the folder are not computed again. Failed points are no error: they
// are counted, and stand in the table with their reason. ERROR_INTERRUPT: stopped, table written.
bool amontons_sweep(const char *path, const SweepOptions *options, SweepSummary *summary,
                    Error *err);
// In a job of Slurm: the points that amontons_sweep has left to this element of its array.
bool amontons_sweep_element(const char *path, const SweepOptions *options, int32_t element,
                            Error *err);

typedef struct InfoOptions {
    const char *const *overrides;   // [override_count] "rod.width=1" of a scene, "n=4" of a .geo
    int32_t override_count;
    const char *picture;   // .png, .pdf or .svg of the mesh, or a scene's mesh and rod; NULL: none
    bool overwrite;   // what is there goes; else it is refused, if no list has it
    bool trust;   // of a mesh or scene, as amontons_scene_read_trusted
} InfoOptions;
// Says in text what a mesh (.msh, .geo), a scene (.yaml) or a result folder holds; NULL: plain.
bool amontons_info(const char *path, const InfoOptions *options, FILE *out, Error *err);
#ifdef __cplusplus
}
#endif
#endif
