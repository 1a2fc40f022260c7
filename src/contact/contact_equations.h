// SPDX-License-Identifier: GPL-2.0-or-later
// The equations of a contact problem while the statuses stay (Alart and Curnier, Comp. Meth. Appl.
// Mech. Eng. 92, 1991, in their status form), and their derivatives. With r = S v - g, an unknown
// that is not held has the equation
//
//     open node, rod node off         E_k = r_k
//     slipping tangent t of normal n  E_t = r_t + s mu(|v_t|) r_n,       s = +1, -1: sign of slip
//     soft rod node that touches      E_x = r_x + stiffness (v_x - bound_x)
//
// and, as s^2 = 1, a row of the derivative by the velocities is
//
//     S_k + s mu S_n + (mu'(|v_t|) r_n + stiffness) e_k.
//
// Held are normals that touch (at their bound), tangents that stick (at 0) and rigid rod nodes that
// touch (at their bound). Used by contact/contact_solver.
#ifndef AMONTONS_CONTACT_CONTACT_EQUATIONS_H
#define AMONTONS_CONTACT_CONTACT_EQUATIONS_H

#include "contact/contact_problem.h"

// The terms beside r_k in the equation of a free unknown: `mu` times r_n and a spring. Both are 0
// where it neither slips nor is soft; then `normal` is the unknown itself.
typedef struct ContactRow {
    int32_t normal;
    double mu;   // s mu(|v_t|), 1
    double stiffness;   // of the spring at a soft rod node, force/width per velocity
} ContactRow;

// Nothing is owned.
typedef struct ContactEquations {
    const ContactProblem *problem;
    ContactSolution *at;
    int32_t *free;   // [count] unknowns that are solved for, free_count of them
    int32_t free_count;
    ContactRow *row;   // [count] work: of what is free, as contact_find_rows left them
} ContactEquations;

// Scales that make forces and velocities comparable; neither is 0.
typedef struct ContactScales {
    double force;   // the largest of g, and of `reaction` [count] unless that is NULL
    double velocity;   // that over the largest diagonal entry of S
} ContactScales;

ContactScales contact_scales(const ContactProblem *problem, const double *reaction);

// The slipping node that `unknown` is the tangent of; -1: none.
static inline int32_t contact_slipping_node(const ContactEquations *equations, int32_t unknown)
{
    const Interface *interface = equations->problem->interface;
    int32_t i = dof_node(interface->dim, unknown);
    if (i >= interface->contact_count || unknown != interface_tangent(interface, i)) return -1;
    return status_slips(equations->at->status[i]) ? i : -1;
}

// Statuses of nodes and of the rod as one list [contact_count + rod_count], to compare with later.
void contact_copy_statuses(const ContactEquations *equations, uint8_t *copy);
bool contact_has_statuses(const ContactEquations *equations, const uint8_t *copy);

// Lists the free unknowns, ascending, without those of open nodes.
void contact_list_free(ContactEquations *equations);

// Puts what is held in its place; what is free keeps its velocity.
void contact_hold(const ContactEquations *equations);

// r = S v - g, from the velocities as they are.
void contact_react(const ContactEquations *equations);

// The rows of what is free, at the velocities as they are: the three below read them, so that
// friction is looked up once for all of them.
void contact_find_rows(const ContactEquations *equations);

// residual [free_count] = E of the free unknowns, force/width.
void contact_residuals(const ContactEquations *equations, double *residual);

// out [free_count] = x_k + s mu x_n: how their equations take what is added to the reactions.
void contact_combine(const ContactEquations *equations, const double *x, double *out);

// The derivative by the free unknowns, column after column with `stride` >= free_count entries
// each. matrix: S, or S with open nodes condensed out, [count^2].
void contact_jacobian(const ContactEquations *equations, const double *matrix, int32_t stride,
                      double *jacobian);

// The status that contact node i, or 1 where rod node j touches, should have by its own conditions,
// and by how much it violates them now, in units of the scales. In the plane this decides when a
// node begins to slip: |r_t| > mu r_n with mu at rest (friction_threshold). Three other places ask
// the same in other unknowns: contact/contact_discs in space, where the status follows from where
// r - rho v lies; contact/contact_sweeps for a node alone, as a start that is judged here or there
// afterwards; stepping/explicit_reference, which solves nothing, for the speed that is left.
uint8_t contact_judge_node(const ContactEquations *equations, ContactScales scales, int32_t i,
                           double *violation);
uint8_t contact_judge_rod(const ContactEquations *equations, ContactScales scales, int32_t j,
                          double *violation);

#endif
