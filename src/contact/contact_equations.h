// SPDX-License-Identifier: GPL-2.0-or-later
// The contact problem as equations for a semismooth Newton method (Alart and Curnier, Comp. Meth.
// Appl. Mech. Eng. 92, 1991), in the plane with one tangent and in space with two. With
// r = S v - g and rho the node's own entry of S, the status of a node follows from r - rho v:
//
//     p = r_n - rho_n (v_n - bound) <= 0     open
//     z = r_t - rho v_t, |z| <= mu p         sticks
//     else                                   slips along d = -z/|z|, |v_t| = s
//
// Open nodes are condensed out (contact/contact_newton). Normals that touch are held at their
// bound, tangents that stick at 0, rigid rod nodes that touch at their bound. What is left is free,
// and each unknown of it has an equation:
//
//     slips       d.r_t + mu(s) r_n = 0
//     in space    theta e.r_t + (1 - theta) rho e.v_t = 0, e across d,
//                 theta = rho s/(mu p + rho s)
//     rod node    r_x = 0, or r_x + stiffness (v_x - bound_x) = 0 where it is soft and touches
//
// The first two say r_t = -mu(s) r_n v_t/s. The second is e.(r_t + mu r_n v_t/s) by theta: so
// a node that only starts, s = 0, holds its direction, and one that slips fast turns as its force
// does. Their derivatives beside S: mu'(s) r_n along the slip, (1 - theta) rho across. An equation
// is linear in r, so that rows found at an earlier r (a warm start) meet the r of this g. Where
// friction creeps nothing sticks, and d is v_t/s for s > 0. mu/s is mu'(0) at rest where mu(0) = 0.
#ifndef AMONTONS_CONTACT_CONTACT_EQUATIONS_H
#define AMONTONS_CONTACT_CONTACT_EQUATIONS_H

#include "contact/contact_problem.h"
#include "contact/slip.h"

// The equations of a slipping node, beside S. Of one tangent d is 1 or -1, the second component 0.
typedef struct ContactRow {
    double d[TANGENTS_MAX];   // along the slip, against friction; e = (-d[1], d[0])
    double mu;
    double theta;   // 0 where it starts, its direction held; 1 of fast slip, which turns freely
    double rho;   // force/width per velocity
    double slope[TANGENTS_MAX];   // mu' r_n v_t/s: how friction along d answers to v_t
} ContactRow;

// Scales that make forces and velocities comparable; neither is 0.
typedef struct ContactScales {
    double force;   // the largest of g, and of `reaction` [count] unless that is NULL
    double velocity;   // that over the largest diagonal entry of S
} ContactScales;

// Nothing is owned.
typedef struct ContactEquations {
    const ContactProblem *problem;
    ContactSolution *at;   // a slipping node is CONTACT_SLIP_FORWARD here, whichever way it slips
    double tolerance;   // of forces that statuses are judged by, relative to scales.force
    ContactScales scales;   // as the last judgement found them
    int32_t *free;   // [count] unknowns that are solved for, free_count of them, ascending
    int32_t *node;   // [count] whose tangent each of them is; -1: a rod node's
    int32_t free_count;
    ContactRow *row;   // [contact_count] of slipping nodes, as the last judgement left them; those
        // of other nodes are left over
} ContactEquations;

ContactScales contact_scales(const ContactProblem *problem, const double *reaction);

// Statuses of nodes and of the rod as one list [contact_count + rod_count], to compare with later.
void contact_copy_statuses(const ContactEquations *equations, uint8_t *copy);
bool contact_has_statuses(const ContactEquations *equations, const uint8_t *copy);

// Rows at what was handed in, whose reactions may be of another g. A node that was said to slip and
// by these would not sticks at first; other statuses stay.
void contact_take_statuses(ContactEquations *equations);

// Statuses of all nodes, and of the rod, and rows of what slips, as velocities and reactions have
// them now. Here a node begins to slip. false: no status has changed.
bool contact_judge(ContactEquations *equations);

// Where friction falls faster with its slip than S resists, slow slip is no solution: a node that
// is overloaded at rest slips against its friction by Newton's step. Those that did so in the last
// step, with the statuses `stepped` [contact_count], and whose friction falls by more than `least`
// times rho, start again beyond the weakening, v = d friction_spent_speed. Reactions and rows are
// the caller's. false: there is no such node.
bool contact_start_fast(const ContactEquations *equations, const uint8_t *stepped, double least);

// Lists the free unknowns, ascending, without those of open nodes.
void contact_list_free(ContactEquations *equations);

// Puts what is held in its place; what is free keeps its velocity.
void contact_hold(const ContactEquations *equations);

// r = S v - g, from the velocities as they are.
void contact_react(const ContactEquations *equations);

// A node that touches nothing has no force, not even rounding.
void contact_release(const ContactEquations *equations);

// Makes exact what was solved to the tolerance, and says which way nodes slip. A node may slip
// against its friction's direction by the tolerance, which beside a rod slow enough is more than
// rounding: it rests, and friction is what holds it. Releases, too.
void contact_clean(const ContactEquations *equations);

// Sum of |v_t|^2 over the nodes that are not open.
double contact_slip_square(const ContactEquations *equations);

// Whether velocities and reactions are finite, those of what is held, too.
bool contact_is_finite(const ContactEquations *equations);

// residual [free_count] of the equations of the free unknowns. kept [contact_count]:
// rows whose directions they are turned into, those of an earlier derivative; NULL: their own.
// Returns the largest force that any is off; infinite where a number is not finite.
double contact_residuals(const ContactEquations *equations, const ContactRow *kept,
                         double *residual);

// out [free_count] += how equations with these rows take what is added to the reactions, x [count].
void contact_combine(const ContactEquations *equations, const ContactRow *rows, const double *x,
                     double *out);

// Column b of the derivative by the free unknowns, out [free_count]. matrix [count^2]: S, or S with
// open nodes condensed out.
void contact_derivative_column(const ContactEquations *equations, const double *matrix, int32_t b,
                               double *out);

#endif
