// SPDX-License-Identifier: GPL-2.0-or-later
// The contact problem's fall-back: a path that leads to a solution when Newton's statuses do not
// settle. Lemke's idea (Cottle, Pang and Stone, The Linear Complementarity Problem, 1992, 4.4; for
// friction Stewart and Trinkle, Int. J. Numer. Meth. Eng. 39, 1996), with friction that depends on
// velocity followed by arcs instead of rays: the problem is embedded in
//
//     S v = g - tau d + r,     d > 0 at normals, 0 at tangents and at the rod.
//
// For large tau everything is pressed so hard that it sticks, and only that solves it. From there a
// path of solutions goes to tau = 0: the equations of given statuses leave one degree of freedom,
// where a status reaches its bound it is exchanged for the next one and the path goes on. It may
// turn back in tau on the way (then there are several solutions); where no two bounds are reached
// at once it cannot end but at tau = 0 or in another solution for tau to infinity, which mu_K > 0
// (and S positive definite) excludes. Called by contact/contact_solver.
#ifndef AMONTONS_CONTACT_CONTACT_PATH_H
#define AMONTONS_CONTACT_CONTACT_PATH_H

#include "contact/contact_equations.h"

typedef struct ContactPath {
    int32_t count;   // interface unknowns
    int32_t *free;   // [count] unknowns that are not held; owned, like all that follows
    ContactRow *equation;   // [count] work: their equations
    int32_t *pivots;   // [count + 1]
    double *matrix;   // [(count + 1)^2]
    double *lift;   // [count] d, force/velocity: tau is a velocity
    double *row;   // [count + 1] what must grow along the path
    double *tangent;   // [count + 1] of the free unknowns and of tau
    double *velocity_rate, *reaction_rate;   // [count] along the tangent
    double *kept;   // [count] free unknowns at the step's start
    uint8_t *piece;   // [contact_count] of its law, where it slips (friction_branch)
    int64_t steps;   // counted: bounds reached, and points between
} ContactPath;

bool contact_path_create(const Interface *interface, ContactPath *path, Error *err);
void contact_path_destroy(ContactPath *path);

// The solution at the path's end, to some digits, in `solution`; what stands there before does not
// matter. false: no path, or it was too long to be followed to its end. Allocates nothing.
bool contact_path_follow(ContactPath *path, const ContactProblem *problem,
                         ContactSolution *solution);

#endif
