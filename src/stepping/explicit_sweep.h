// SPDX-License-Identifier: GPL-2.0-or-later
// What stepping/explicit_reference does at every node of the mesh: where its vectors stand, its
// matrices by blocks, and the step that is free of contact.
#ifndef AMONTONS_STEPPING_EXPLICIT_SWEEP_H
#define AMONTONS_STEPPING_EXPLICIT_SWEEP_H

#include "base/lanes.h"
#include "stepping/explicit_reference.h"

// Numbers that u or v of a node, or a column of a block, take up.
static inline int32_t explicit_room(const ExplicitReference *scheme)
{
    return scheme->def.interface->dim == 2 ? 2 : LANE;
}

// All of u and v.
static inline int64_t explicit_field_size(const ExplicitReference *scheme)
{
    return 2 * (int64_t)explicit_room(scheme) * scheme->node_count;
}

// Where u of a node stands in it, and v.
static inline int64_t explicit_place(const ExplicitReference *scheme, int32_t node)
{
    return 2 * (int64_t)explicit_room(scheme) * node;
}
static inline int64_t explicit_velocity(const ExplicitReference *scheme, int32_t node)
{
    return explicit_place(scheme, node) + explicit_room(scheme);
}

// Blocks of K and C, and dt / mass, of scheme->def.
bool explicit_sweep_create(ExplicitReference *scheme, Error *err);

// now -> next as if nothing were touched. Returns v C v, the viscous power.
double explicit_sweep(ExplicitReference *scheme);

#endif
