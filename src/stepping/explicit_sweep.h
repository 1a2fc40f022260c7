// SPDX-License-Identifier: GPL-2.0-or-later
// The sweep of stepping/explicit_reference over every node of the mesh: where its vectors stand,
// its matrices by blocks, and the step that is free of contact.
#ifndef AMONTONS_STEPPING_EXPLICIT_SWEEP_H
#define AMONTONS_STEPPING_EXPLICIT_SWEEP_H

#include "algebra/lanes.h"
#include "fem/assembly.h"

typedef struct ExplicitSweep {
    const Bulk *bulk;   // not owned
    double step;   // dt, time
    int32_t node_count;
    int32_t *start;   // [node_count + 1] of the node's blocks; owned, like all that follows
    int32_t *column;   // [blocks] node; the first of each row is the diagonal
    double
        *blocks;   // [blocks * block_size] upper triangle of K and C by nodes, see explicit_sweep.c
    double *kick;   // [node_count] dt / mass
    double *now;   // [field_size] u of a node at t_n, then its v at t_n - dt/2
    double *next;   // [field_size] the same a step later
    double *force;   // [field_size] work: K u, C v
    double *pull;   // [dof_count] forces of the materials' branches at t_n; NULL: there are none
} ExplicitSweep;

// Numbers that u or v of a node, or a column of a block, take up.
static inline int32_t explicit_room(const ExplicitSweep *sweep)
{
    return sweep->bulk->dim == 2 ? 2 : LANE;
}

// All of u and v.
static inline int64_t explicit_field_size(const ExplicitSweep *sweep)
{
    return 2 * (int64_t)explicit_room(sweep) * sweep->node_count;
}

// Index of the first component of a node's u in the array that it shares with v.
static inline int64_t explicit_place(const ExplicitSweep *sweep, int32_t node)
{
    return 2 * (int64_t)explicit_room(sweep) * node;
}
static inline int64_t explicit_velocity(const ExplicitSweep *sweep, int32_t node)
{
    return explicit_place(sweep, node) + explicit_room(sweep);
}

// Blocks of K and C, and dt / mass; nothing moves. On failure explicit_sweep_destroy frees what was
// made.
bool explicit_sweep_create(const Bulk *bulk, double step, ExplicitSweep *sweep, Error *err);
void explicit_sweep_destroy(ExplicitSweep *sweep);

// now -> next as if nothing were touched, under `factor` times the load. Returns v C v, the viscous
// power.
double explicit_sweep_free(ExplicitSweep *sweep, double factor);

#endif
