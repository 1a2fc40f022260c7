// SPDX-License-Identifier: GPL-2.0-or-later
// A simulation in pieces, for callers who step by themselves. Public, as amontons.h.
#ifndef AMONTONS_SIMULATION_H
#define AMONTONS_SIMULATION_H

#include "amontons.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct Simulation Simulation;   // one computation on its way; opaque

// `create` meshes, assembles and relaxes to t = 0; where it fails *simulation may hold what was
// made, to be destroyed. `step` does one accepted step and says whether the scene's end is reached.
// `finish` writes results and pictures; after it there is nothing but to look and to destroy
// (ERROR_INPUT).
bool amontons_simulation_create(const Scene *scene, const RunOptions *options,
                                Simulation **simulation, Error *err);
bool amontons_simulation_step(Simulation *simulation, StepView *view, bool *finished, Error *err);
void amontons_simulation_view(const Simulation *simulation, StepView *view);   // as it is now
bool amontons_simulation_finish(Simulation *simulation, RunSummary *summary, Error *err);
void amontons_simulation_destroy(Simulation *simulation);   // NULL is fine

// Between two steps. Not under time.scheme explicit (ERROR_INPUT, as for all that is not possible).
// The rod moves on with `velocity` (0: it stands; below 0: back) from where it is; the scene ends
// when it comes to time.until.U, or at time.until.t. The velocity of the scene stays what slip is
// called rapid by.
bool amontons_simulation_set_rod_velocity(Simulation *simulation, double velocity, Error *err);
// The pressure on the top is `pressure` from now on, put on at once; mu is over the load that acts.
// Where load.pressure is the only load, and on the full mesh (reduction.use: never).
bool amontons_simulation_set_pressure(Simulation *simulation, double pressure, Error *err);

// Size of a run of the scene. Nothing but the mesh is made. Of a scene with accuracy.mu:
// one run on its first mesh.
typedef struct RunForecast {
    int32_t elements, contact_nodes, unknowns;   // of the mesh
    bool reduced;   // else stepped on the full mesh
    bool held;   // the reduction is in the cache
    double mesh;   // processor time to read the mesh now, s
    double memory;   // bytes at most, about; 0: not known, as on the full mesh in the plane
    char mesh_moved[MESH_MOVED_SIZE];   // as in RunSummary
} RunForecast;
bool amontons_forecast(const Scene *scene, RunForecast *forecast, Error *err);

// A saved state: everything on which the next steps and the results depend, to the last bit, with a
// checksum. One file of it is what `amontons run` leaves as checkpoint.bin.
typedef struct SavedState {
    void *bytes;   // [size] amontons_state_free
    int64_t size;
} SavedState;

// Between two steps. `restore` puts a simulation to where the saved one was: of the same scene
// (time.until, title and pictures may differ), mesh and version. ERROR_INPUT: it is of others, and
// nothing was changed; after any other error the simulation can only be destroyed. A history in a
// result folder is cut back to that step; it must go as far.
bool amontons_simulation_save(Simulation *simulation, SavedState *state, Error *err);
bool amontons_simulation_restore(Simulation *simulation, const SavedState *state, Error *err);
bool amontons_state_write(const SavedState *state, const char *path, Error *err);
bool amontons_state_read(const char *path, SavedState *state, Error *err);
void amontons_state_free(SavedState *state);   // zeroed is fine

// All nodes of the mesh; dimensions: 2, x and z. The arrays belong to the simulation; displacement
// and velocity are recovered at each call, and stay until the next.
typedef struct BlockView {
    int32_t nodes, dimensions, elements;
    const double *position;   // [nodes][dimensions] undeformed, length
    const double *displacement;   // [nodes][dimensions] length
    const double *velocity;   // [nodes][dimensions]
    const int32_t *first_node;   // [elements + 1] where the nodes of an element begin in
        // element_nodes, corners first, in gmsh's order
    const int32_t *element_nodes;   // node numbers, from 0
} BlockView;
// ERROR_INPUT without RunOptions.whole_block.
bool amontons_simulation_block(Simulation *simulation, BlockView *view, Error *err);

#ifdef __cplusplus
}
#endif

#endif
