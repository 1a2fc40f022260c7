// SPDX-License-Identifier: GPL-2.0-or-later
// Active-set Newton for the contact problem of one stage (Alart and Curnier, Comp. Meth. Appl.
// Mech. Eng. 92, 1991, in its status form). For given statuses the unknowns are the slipping
// tangents, both components of open nodes and the rod nodes that are soft or do not touch; all else
// is held. One Newton step on those (contact/contact_equations), then every status is checked
// against its own conditions and changed where it violates them (contact/contact_newton). When
// statuses cycle, only the worst one is changed at a time; when that does not settle either, or the
// residual no longer falls, sweeps over the nodes lead to other statuses (contact/contact_sweeps).
// There is a solution, as S is positive definite and mu bounded and continuous. Where even so none
// is found, or the caller prefers a shorter step to sweeps, the problem counts as unsolved and the
// caller must take a shorter step. All of this holds for one tangent; in space
// contact/contact_discs solves. Called by stepping/sdirk.
#ifndef AMONTONS_CONTACT_CONTACT_SOLVER_H
#define AMONTONS_CONTACT_CONTACT_SOLVER_H

#include "contact/contact_discs.h"
#include "contact/contact_newton.h"
#include "contact/contact_problem.h"

typedef struct ContactSolver {
    ContactNewton newton;   // steps with these statuses; owned
    ContactDiscs discs;   // of a contact in space, which uses the same `newton`; owned
    uint8_t *anchor;   // [contact_count + rod_count] work: statuses met before; owned
    int64_t solves;   // counted
    int64_t iterations;   // counted, Newton steps
    int64_t fallbacks;   // counted, solves in which only the worst status was changed
    int64_t sweeps;   // counted, over the nodes of a contact in the plane
    bool sweeps_on;   // where Newton gives up there; true unless the caller has shorter steps
    int64_t rescued;   // counted, solves in which sweeps led to what Newton alone did not find
    int64_t unsolved;   // counted
    double seconds;   // wall time spent
} ContactSolver;

bool contact_solver_create(const Interface *interface, ContactSolver *solver, Error *err);
void contact_solver_destroy(ContactSolver *solver);

// Moves the counts of another solver into this one.
void contact_solver_take_counts(ContactSolver *solver, ContactSolver *from);

// Solves from the statuses in `solution` (warm start). false: unsolved; `solution` then holds no
// meaning. Allocates nothing and sets no error: the caller decides what to do.
bool contact_solve(ContactSolver *solver, const ContactProblem *problem, ContactSolution *solution);

// Counters (whose factors are used again depends on one of them) and what is kept.
void contact_solver_archive(ContactSolver *solver, const Interface *interface, Archive *archive);

#endif
