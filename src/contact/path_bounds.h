// SPDX-License-Identifier: GPL-2.0-or-later
// Where a point of contact/contact_path's path is, and which bound of a status it reaches next.
#ifndef AMONTONS_CONTACT_PATH_BOUNDS_H
#define AMONTONS_CONTACT_PATH_BOUNDS_H

#include "contact/contact_equations.h"

enum { PATH_AT_END = -1, PATH_AT_NO_BOUND = -2 };   // in place of a node

// A point of the path and all that stays the same along it. Nothing is owned.
typedef struct PathTrace {
    struct ContactPath *path;   // whose arrays those below are
    ContactEquations system;   // of problem and at; free: all that is not held
    ContactScales scales;   // by g alone: reactions are not known before the start
    double tau;   // velocity
    double tau_rate;   // along the tangent, and of all unknowns:
    const double *velocity_rate, *reaction_rate;   // [count]
} PathTrace;

// A bound: condition `kind` of contact node `node`, or of rod node `node` - contact_count, or
// (PATH_AT_END) tau = 0.
typedef struct PathBound {
    int32_t node, kind;
    double distance;   // along the tangent
} PathBound;

// Condition `kind` of `node`: >= 0 where its status holds, over its scale; INFINITY: there is no
// such condition. one: 1 for the value at v, r; 0 for the rate at their rates.
double path_condition(const PathTrace *trace, int32_t node, int32_t kind, const double *v,
                      const double *r, double one);

// The bound that the tangent reaches first; distance INFINITY: none.
PathBound path_nearest_bound(const PathTrace *trace);

// The least of all conditions at the point, below 0 where one is violated. tau = 0 counts as one,
// too (PATH_AT_END), so that a step beyond the path's end is cut back to it.
double path_worst_condition(const PathTrace *trace, PathBound *worst);

#endif
