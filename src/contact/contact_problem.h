// SPDX-License-Identifier: GPL-2.0-or-later
// The local problem of one implicit stage, on the interface alone:
//
//     S v = g + r
//     contact, normal     v_n >= bound_n,  r_n >= 0,  (v_n - bound_n) r_n = 0
//     contact, tangent    |r_t| <= mu(|v_t|) r_n,  r_t = -mu(|v_t|) r_n v_t/|v_t| where v_t != 0
//                         vectors of dim - 1 components
//     rod                 v_x >= bound_x,  r_x >= 0,  complementary (push)
//                         v_x  = bound_x (bonded),    r_x = 0 (away)
//                         bound_x - r_x softness/(rod_reach + lag) in its place at a soft node
//
// The bounds say in velocities that the end of the stage must not penetrate:
// (0 - u*) / (gamma dt) for the plane, (target - u*) / (gamma dt) for the rod.
// Solved by contact/contact_solver, judged by contact/contact_check.
#ifndef AMONTONS_CONTACT_CONTACT_PROBLEM_H
#define AMONTONS_CONTACT_CONTACT_PROBLEM_H

#include "contact/contact_matrix.h"
#include "contact/contact_status.h"
#include "friction/friction.h"
#include "contact/rod.h"

// Nothing is owned.
typedef struct ContactProblem {
    const Interface *interface;
    const Friction *friction;
    RodKind rod_kind;
    const double *rod_softness;   // [rod_count] length per force/width, 0: rigid; NULL: all are
    const double *rod_lag;   // [rod_count] time; NULL: 0
    double rod_reach;   // with the lag, r_x softness over (bound_x - v_x) at a soft node, time
    ContactMatrix *matrix;   // S and what was computed from it; NULL: judged only, not solved
    const double *g;   // [count]
    const double *bound;   // [count] of normals and rod; entries of tangents are not used
} ContactProblem;

// Arrays are the caller's, none of them null. Statuses come in as a guess and go out as found.
typedef struct ContactSolution {
    double *velocity;   // v [count]
    double *reaction;   // r [count]
    uint8_t *status;   // [contact_count] ContactStatus
    uint8_t *rod_touches;   // [rod_count] 1: pressed, or bonded
} ContactSolution;

// Stiffness of the rod at node j, force/width per velocity: r_x = stiffness (bound_x - v_x); 0: it
// is rigid.
static inline double rod_stiffness(const ContactProblem *problem, int32_t j)
{
    bool soft = problem->rod_softness && problem->rod_softness[j] > 0;
    double lag = problem->rod_lag ? problem->rod_lag[j] : 0;
    return soft ? (problem->rod_reach + lag) / problem->rod_softness[j] : 0;
}

#endif
