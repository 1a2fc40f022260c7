// SPDX-License-Identifier: GPL-2.0-or-later
// The interface unknowns F that a small disturbance of a state moves, and the linearised equations
// on them: tangents of slipping nodes, both unknowns of open nodes, rod nodes that do not touch or
// are soft. All else does not move. A slipping node obeys r_t = -d mu(|v_t|) r_n, d the direction
// of slip, and r_n answers to all that moves, so a disturbance v' of the velocities leaves in its
// row
//
//     (S v')_t + d mu (S v')_n - w v'_t,     w = -mu'(|v_t|) r_n
//                                            (linear law: (mu_S - mu_K) r_n / v_c below v_c).
//
// w > 0 is the node's weakening. Where the law strengthens, -w is a damper like any other, and is
// counted among what resists. A soft rod node that touches has a spring and a damper of its own
// (contact/rod).
// Called by stepping/certificate and stepping/growth.
#ifndef AMONTONS_STEPPING_MOVING_SET_H
#define AMONTONS_STEPPING_MOVING_SET_H

#include "stepping/state.h"

typedef struct MovingUnknown {
    int32_t unknown;   // of the interface
    int32_t normal;   // of a slipping tangent; -1: no friction here
    double friction;   // of a slipping tangent: d mu(|v_t|)
    double weakening;   // w >= 0, force * time / length
    double damper;   // of a soft rod node that touches: lag / softness; of a node whose friction
        // strengthens: mu' r_n; force * time / length
    double spring;   // of the same: 1 / softness, force / length
} MovingUnknown;

typedef struct MovingSet {
    const Interface *interface;   // not owned, like the next two
    const FrictionLaw *law;
    const Rod *rod;
    MovingUnknown *list;   // [interface->count]; owned
    // Of the list once more, close together for what goes through S. Where there is no friction:
    // the unknown itself and 0.
    int32_t *unknown, *normal;   // [interface->count]; owned
    double *friction;   // likewise
    int32_t count;   // |F|
    bool weakens;   // some weakening is above 0
} MovingSet;

bool moving_set_create(const Block *block, MovingSet *set, Error *err);
void moving_set_destroy(MovingSet *set);

// Lists what `state` lets move. with_open false: open nodes are left out, as in matrices that have
// them condensed out (contact/contact_matrix).
void moving_set_find(MovingSet *set, const State *state, bool with_open);

// matrix = factor S[F,F] + keep matrix [count^2]. schur: S [interface->count^2], symmetric.
void moving_set_gather(const MovingSet *set, const double *schur, double factor, double keep,
                       double *matrix);
// Adds d mu S[n,F] to the rows of slipping tangents: the pressure that follows slip.
void moving_set_couple(const MovingSet *set, const double *schur, double *matrix);
// Both at once, of that matrix only the symmetric part, and of this the lower triangle.
void moving_set_gather_symmetric(const MovingSet *set, const double *schur, double *matrix);
// Adds dampers, and springs times `reach` (velocity to displacement, time; 0: none), to the
// diagonal.
void moving_set_add_dampers(const MovingSet *set, double reach, double *matrix);
void moving_set_subtract_weakening(const MovingSet *set, double *matrix);

#endif
