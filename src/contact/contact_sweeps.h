// SPDX-License-Identifier: GPL-2.0-or-later
// Projected Gauss-Seidel sweeps for the contact problem in space: one node after the other takes
// the velocity that keeps all of its conditions while the others' velocities stay. Slow to end, but
// sure to come near: where contact/contact_discs starts again.
#ifndef AMONTONS_CONTACT_CONTACT_SWEEPS_H
#define AMONTONS_CONTACT_CONTACT_SWEEPS_H

#include "contact/contact_problem.h"

// So many sweeps from the velocities as they are; reactions and statuses go out with them.
void contact_sweep(const ContactProblem *problem, ContactSolution *solution, int32_t sweeps);

#endif
