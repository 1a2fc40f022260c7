// SPDX-License-Identifier: GPL-2.0-or-later
// The contact problem of one stage, in the plane and in space, by a semismooth Newton method
// (contact/contact_equations, contact/contact_newton): a step of the free unknowns, then every
// status is found again, and so on. A step after which the residual is larger is halved. Where
// that does not settle, sweeps over the nodes come next (contact/contact_sweeps), then steps again,
// then more sweeps. There is a solution, as S is positive definite and mu bounded and continuous.
// Where even so none is found, or the caller prefers a shorter step to sweeps, the problem counts
// as unsolved and the caller must take a shorter step. Called by stepping/sdirk.
#ifndef AMONTONS_CONTACT_CONTACT_SOLVER_H
#define AMONTONS_CONTACT_CONTACT_SOLVER_H

#include "contact/contact_newton.h"
#include "contact/contact_problem.h"

typedef struct ContactSolver {
    ContactNewton newton;   // steps with these statuses; owned
    uint8_t *anchor;   // [contact_count + rod_count] work: statuses met before; owned
    bool sweeps_on;   // where Newton does not settle; true unless the caller has shorter steps
    int64_t solves;   // counted
    int64_t iterations;   // counted, Newton steps
    int64_t fallbacks;   // counted, solves that Newton's steps alone did not settle
    int64_t sweeps;   // counted, over the nodes
    int64_t rescued;   // counted, solves in which sweeps led to what Newton alone did not find
    int64_t unsolved;   // counted
    double seconds;   // wall time spent
} ContactSolver;

bool contact_solver_create(const Interface *interface, ContactSolver *solver, Error *err);
void contact_solver_destroy(ContactSolver *solver);

// Moves the counts of another solver into this one.
void contact_solver_take_counts(ContactSolver *solver, ContactSolver *from);

// Solves from the velocities, reactions and statuses in `solution`, which may be those of another g
// (warm start). false: unsolved; `solution` then holds no meaning. Allocates nothing and sets no
// error: the caller decides what to do.
bool contact_solve(ContactSolver *solver, const ContactProblem *problem, ContactSolution *solution);

// Counters (`factorisations` decides whose factors are used again) and the factors. Part of the
// state of stepping/sdirk and stepping/half_step.
void contact_solver_archive(ContactSolver *solver, const Interface *interface, Archive *archive);

#endif
