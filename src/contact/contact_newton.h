// SPDX-License-Identifier: GPL-2.0-or-later
// Newton's steps on what is free while statuses stay. Open nodes are condensed out: with S' (the
// matrix of contact/contact_matrix for them) and what is free, F, a step x of the velocities of F
// changes reactions by S'_.F x elsewhere and moves open nodes by -S_OO^-1 S_OF x, which one product
// with columns of S' gives. S v, which has the columns of the open nodes as well, is found as a
// whole before the first step and after the last (`exact`): on pads most nodes are open and few
// slip.
// Factors of the derivative are kept and used again while steps with them gain (a chord method).
// Used by contact/contact_solver, which changes the statuses.
#ifndef AMONTONS_CONTACT_CONTACT_NEWTON_H
#define AMONTONS_CONTACT_CONTACT_NEWTON_H

#include "contact/contact_equations.h"

// LU of the derivative, kept from one Newton step to the next.
typedef struct ContactFactors {
    int32_t rows;   // 0: none is kept
    bool is_single;   // they are in single precision, of the derivative over the largest entry of S
    double *lu;   // [rows^2], of floats where is_single; owned, like all that follows
    int32_t *pivots;   // [rows]
    uint8_t *status;   // [contact_count + rod_count] that it is for (contact_copy_statuses)
    ContactRow *row;   // [contact_count] that it is for
    double *column;   // [PARALLEL_WORKERS_MAX * count] work
} ContactFactors;

typedef struct ContactNewton {
    ContactEquations equations;   // of the solve under way; its problem ends with it, rows stay
    double rounding;   // forces at open nodes below it are left
    int32_t open_count;   // unknowns of open nodes, in `open`
    const double *condensed;   // S'
    bool listed;   // `free`, `open` and S' are those of the statuses
    bool exact;   // reactions are S v - g, not what steps added up to
    bool creeps;   // some node never sticks, by its law
    bool in_double;   // factors are in double precision; else in single, which residuals of double
        // precision make up for by hardly a step more, for half the time
    bool reused;   // the last step was one with the factors of an earlier derivative
    int32_t *free;   // [count] work; owned, as all that follows
    int32_t *node;   // [count] work: of what is free
    int32_t *open;   // [count] work: unknowns of open nodes
    ContactRow *row;   // [contact_count] of slipping nodes
    double *step;   // [count] of the last step, of what is free
    double *residual, *more;   // [count] work
    double *pull;   // [count] work: what open nodes do to the others
    ContactFactors factors;   // of the last derivative
    bool factors_gain;   // steps with them have gained a digit since
    int64_t factorisations;   // counted
} ContactNewton;

// On failure contact_newton_destroy frees what was made.
bool contact_newton_create(const Interface *interface, ContactNewton *newton, Error *err);
void contact_newton_destroy(ContactNewton *newton);

// A solve begins with the statuses of `solution`, and with rows at its velocities and reactions,
// which may be of another g: held unknowns take their values, and reactions are found. tolerance:
// of residual forces, relative to the largest.
void contact_newton_begin(ContactNewton *newton, const ContactProblem *problem,
                          ContactSolution *solution, double tolerance);

// Reactions are S v - g, S v with all its columns.
void contact_newton_react(ContactNewton *newton);

// Where statuses have changed: held unknowns take their values, and reactions follow by the columns
// of what moved.
void contact_newton_settle(ContactNewton *newton);

// Where slow slip is no solution: what statuses hold takes its values, and the nodes that slipped
// against their friction in the last step start again beyond the weakening (contact_start_fast).
// false: there is none, and nothing has changed.
bool contact_newton_start_fast(ContactNewton *newton, double least);

// One step. false: the derivative is singular, nothing holds the open nodes, or a number is not
// finite.
bool contact_newton_step(ContactNewton *newton);

// Takes back half of the last step, or of what is left of it.
void contact_newton_halve(ContactNewton *newton);

// The largest residual of any equation, with rows as they are, and of the forces at open nodes,
// force/width; infinite where a number is not finite.
double contact_newton_residual(ContactNewton *newton);

// First-order change of a solution with these statuses and rows [contact_count] under small changes
// of g and of the bounds, which `problem` has; it may have another matrix of as many unknowns. At a
// solution friction lies along the slip (e.r_t = 0), so that the derivative of its direction has no
// part in the equations: they are linear, with directions held. false: the derivative is singular.
bool contact_newton_follow(ContactNewton *newton, const ContactRow *rows,
                           const ContactProblem *problem, ContactSolution *solution);

// Writes or reads all that outlives a solve.
void contact_newton_archive(ContactNewton *newton, const Interface *interface, Archive *archive);

#endif
