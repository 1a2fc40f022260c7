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
#include "contact/contact_problem.h"

// LU of the derivative, kept from one Newton step to the next.
typedef struct ContactFactors {
    int32_t rows;   // 0: none is kept
    double *lu;   // [rows^2]; owned, like all that follows
    int32_t *pivots;   // [rows]
    uint8_t *status;   // [contact_count + rod_count] that it is for (contact_copy_statuses)
} ContactFactors;

typedef struct ContactNewton {
    ContactEquations equations;   // of the solve under way. free: tangents of nodes that slip, rod
        // nodes that are soft or do not touch; ascending
    double rounding;   // forces at open nodes below it are left
    int32_t open_count;   // unknowns of open nodes, in `open`
    const double *closed;   // S'
    bool listed;   // what is free, open and closed is that of the statuses, and `step` has the
        // residuals of what is free
    bool exact;   // reactions are S v - g, not what steps added up to
    bool creeps;   // nodes never stick, by their law
    bool reused;   // the last step was one with the factors of an earlier matrix
    int32_t *free;   // [count] work; owned, as all that follows
    int32_t *open;   // [count] work: unknowns of open nodes
    ContactRow *row;   // [count] work: the equations of what is free
    double *step, *more;   // [count] work
    double *pull;   // [count] work: what open nodes do to the others
    ContactFactors factors;   // of the last derivative
    bool factors_gain;   // steps with them have gained a digit since
    int64_t factorisations;   // counted
} ContactNewton;

// On failure contact_newton_destroy frees what was made.
bool contact_newton_create(const Interface *interface, ContactNewton *newton, Error *err);
void contact_newton_destroy(ContactNewton *newton);

// A solve begins: held unknowns take their values, and reactions are found. rounding: part of the
// largest entry of g.
void contact_newton_begin(ContactNewton *newton, const ContactProblem *problem,
                          ContactSolution *solution, double rounding);

// Reactions are S v - g, S v with all its columns.
void contact_newton_react(ContactNewton *newton);

// The same where statuses have changed; reactions follow by the columns of what moved.
void contact_newton_settle(ContactNewton *newton);

// Lists what is free and open by the statuses as they are. false: nothing holds the open nodes.
bool contact_newton_list(ContactNewton *newton);

// The same without residuals, which are the caller's.
bool contact_newton_close(ContactNewton *newton);

// Bends newton->step at nodes of laws that creep; does nothing to others.
void contact_newton_creep(ContactNewton *newton);

// Parts of a step, of those who find `step` themselves. `pull` = S' r_O: what the forces at open
// nodes do to the others when they are taken away; and then what `step` makes of velocities and
// reactions.
void contact_newton_find_pull(ContactNewton *newton);
void contact_newton_take(ContactNewton *newton);

// True if the stored factors may be used again: they are the latest, of this S and of these
// statuses, and steps with them gain. Factors of another step size would converge too slowly, and
// where friction creeps each row changes from step to step.
bool contact_newton_keeps_factors(const ContactNewton *newton);

// One step, after contact_newton_list and with residuals in `step`. false: the derivative is
// singular.
bool contact_newton_step(ContactNewton *newton);

// Residuals of the equations of what is free, into `step`. The largest of them and of the forces at
// open nodes, force/width; infinite where a number is not finite.
double contact_newton_residual(ContactNewton *newton);

// Writes or reads all that outlives a solve. count: interface unknowns.
void contact_newton_archive(ContactNewton *newton, int32_t count, Archive *archive);

// The factors by themselves.
bool contact_factors_create(const Interface *interface, ContactFactors *factors, Error *err);
void contact_factors_destroy(ContactFactors *factors);

// LU of the derivative as contact_jacobian has it. false: it is singular, and none is kept.
bool contact_factors_make(ContactFactors *factors, const ContactEquations *equations,
                          const double *matrix);

// x [rows] := J^-1 x.
void contact_factors_solve(const ContactFactors *factors, double *x);

void contact_factors_archive(ContactFactors *factors, int32_t count, Archive *archive);

#endif
