// SPDX-License-Identifier: GPL-2.0-or-later
// State that the parts of a search for an error bar share: run/accuracy goes from mesh to mesh,
// run/accuracy_member does one run. amontons.h declares the part that the caller sees.
//
// Time (accuracy.within) ends a search inside a run. A part of this time is kept for the run in
// full on the last mesh that has a whole one. A run, or a mesh, is not begun if the forecast says
// that it takes longer than the time left before that. A run that was cut short has no part in the
// bar. If it was the first run of all, its own answers stand, without a bar.
#ifndef AMONTONS_RUN_ACCURACY_STATE_H
#define AMONTONS_RUN_ACCURACY_STATE_H

#include "answers/error_bars.h"
#include "run/simulation_state.h"

// Ratio of cell sizes from level to level where cells can only be halved (no .geo with `refine`),
// and the largest ratio where the last mesh does not resolve slip.
enum { RATIO_SPLIT = 2 };

typedef struct Accuracy {
    const Scene *scene;
    const RunOptions *options;
    Levels levels;
    double cell_ratio;   // of cells of a level to those of the next
    int32_t members;   // whole runs behind the bar, but for that in full
    double started, deadline;   // wall clock, s; INFINITY: accuracy.within is not given
    double begun;   // wall clock at which the run under way began, s
    double stepping;   // expected of the run in full, s; 0: no run is whole
    double making;   // likewise of its mesh and basis; 0: the cache has them
    bool out_of_time;
    char passed_over[400];   // why the last mesh that failed was passed over; "": none was
    Answers so_far;   // of the run under way
    char stage[64];   // of it, as the caller is told
    Simulation *cut;   // the first run of all, where time cut it short; owned
} Accuracy;

Level *accuracy_last_level(Accuracy *accuracy);
// Before another mesh is looked at: two on the first, where they tell branches from the mesh, and
// where meshes are few as each halves the cells of the last; else one.
int32_t accuracy_runs_first(const Accuracy *accuracy);
// Kept back for the run in full, s, where it takes so many times as long.
double accuracy_full(const Accuracy *accuracy, double times);
// For runs behind the bar, s: what the run in full needs is kept back. INFINITY: no limit.
double accuracy_seconds_left(const Accuracy *accuracy);
// Returns true if the change that more slidings could make is a small part of the bar wanted.
bool accuracy_is_known(const Accuracy *accuracy, const Answers *answers);

// The scene of a level: the parameter `refine` of every mesh, times what the scene may have set it
// to (ERROR_INPUT: there is no room for it); pressure and tractions times `factor`.
bool scene_refine(Scene *scene, double refine, Error *err);
void scene_scale_loads(Scene *scene, double factor);

// Adds a run that came to its end, and the pads that slid in it, to the last level.
void accuracy_count_run(Accuracy *accuracy, const Simulation *simulation, double pressure,
                        const Answers *answers);

// One run of the last level, at the next pressure of the window. *coarse (NULL: not asked): the
// mesh has too few contact nodes, as many as the one before, its cells are too long for slip, or
// the run failed. Then, as when time is out, nothing was added.
bool accuracy_run_member(Accuracy *accuracy, bool *coarse, Error *err);

#endif
