// SPDX-License-Identifier: GPL-2.0-or-later
// Where does slow slip lose its stability? The block follows its quasi-static path: steps so
// long that the implicit, L-stable scheme damps whatever would grow, the certificate switched off,
// the rod so slow that the velocity drops out (V -> 0). Whenever a further node begins to slip, the
// growth rates of the state just before are computed (stepping/growth). Or, without a path, those
// of the state in which the scene's own run ends.
// Friction that remembers is on the path's clock (friction_paced): states and mu are those
// of the scene's V. amontons_stability is the entry; this is what its files share.
#ifndef AMONTONS_STUDY_STABILITY_STABILITY_H
#define AMONTONS_STUDY_STABILITY_STABILITY_H

#include "amontons_stability.h"
#include "run/simulation_state.h"
#include "stepping/growth.h"

typedef struct StabilityPath {
    const StabilityOptions *options;   // not owned
    Simulation *simulation;   // the run before the path; owned
    Model *model;   // the simulation's
    Rod rod;   // of the path; owned, like what follows
    double pace;   // of friction that remembers: velocities of the path over the scene's; else 1
    Friction friction;   // at that pace, where friction remembers
    FrictionNode *nodes;   // [contact_count] its nodes; NULL: none remembers; owned
    ObservationScales scales;   // of the path
    StepControl control;   // of the path
    State last;   // before the newest step, in the scene's time
    Growth *growth;
    double slowest;   // rate that it looks for, 1/time
    double U_start;   // of the rod, where the path begins, length
    int32_t count, room;   // points
    StabilityPoint *points;   // [room]
    double *modes;   // [room][2][contact_count] slip of the rightmost mode, re and im; largest 1
    double *critical_mode;   // [contact_count] slip of the real growing mode at l_c
    bool at_end;   // the front has crossed the block
    int32_t critical;   // point where l_c was found; -1: not yet
    int32_t at_rod;   // point where slip first runs away at the scene's V; -1: not yet
    State runaway;   // the state of that point, the last one where none is; owned
    bool grows;   // it was found
    double mu_snap;   // at V, before the first step in which a node jumped; NaN: none did
    int32_t snap_node;   // that node
    double seconds_growth;
} StabilityPath;

// Laws of the path's pace, and the path's state as it begins; does nothing without memory
// (remembers.c).
bool stability_set_pace(StabilityPath *path, double velocity, Error *err);
void stability_start_states(StabilityPath *path);
// path->last is what the path has come to, in the scene's time.
void stability_look(StabilityPath *path);
// Node i of `trial` slips forward: slowly, or where friction remembers steadily at the scene's V.
void stability_let_slip(const StabilityPath *path, State *trial, int32_t i);
// Stiffness of a massless body, stress over length, below which steady slip of node i at V under
// this pressure is not stable. NaN: friction remembers nothing, or its weakening with slip rate
// makes the slip unstable on any spring.
double stability_critical_spring(const StabilityPath *path, int32_t i, double pressure);

// pi Re/Im - ln(v_c/V) of point k: from 0 on slip runs away at the scene's V.
double stability_half_period(const StabilityPath *path, int32_t k);

// l_sc, l_c and the rest that the points tell, as a new summary (loss.c).
void stability_summarise(const StabilityPath *path, StabilitySummary *summary);

// The resistance of each pad in path->runaway, and how much it takes part in the mode of point
// at_rod (pad_growth.c). ERROR_COMPUTE: a small eigenproblem was not solved.
bool stability_measure_pads(StabilityPath *path, StabilitySummary *summary, Error *err);

// Sentences on what decides, and on what a run may do otherwise, into summary->why (why.c).
void stability_explain(const StabilityPath *path, StabilitySummary *summary);

// stability.json and stability.h5 in the options' folder.
bool stability_write(const StabilityPath *path, const StabilitySummary *summary, Error *err);

#endif
