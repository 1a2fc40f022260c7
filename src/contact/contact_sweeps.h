// SPDX-License-Identifier: GPL-2.0-or-later
// Projected Gauss-Seidel sweeps for the contact problem: one node after the other takes the
// velocity that keeps all of its conditions while the others' velocities stay. Slow to end, but
// sure to come near: where contact/contact_solver starts again.
#ifndef AMONTONS_CONTACT_CONTACT_SWEEPS_H
#define AMONTONS_CONTACT_CONTACT_SWEEPS_H

#include "contact/contact_problem.h"

enum { SWEEP_ROUNDS = 4 };

// Round 0 is a few sweeps from the velocities as they are (in the plane contact/contact_solver has
// put them to rest), each further one several times as many.
// In the plane these go there and back, and half as far in each: in one order, or all the way, they
// may go round in a cycle. Reactions and statuses go out with them. Returns how many sweeps it
// took.
int32_t contact_sweep(const ContactProblem *problem, ContactSolution *solution, int32_t round);

#endif
