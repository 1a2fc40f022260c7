// SPDX-License-Identifier: GPL-2.0-or-later
// Equilibrium under given load: K u = f + G' r with the plane, friction and rod of a run,
//
//     S u_b = g + r,   S, g: K and f condensed on the interface,
//
// which is the contact problem of one stage (contact/contact_problem) with displacements in the
// place of velocities: gap u_z >= 0, the rod at its displacement, friction Coulomb's with
// mu_static, stick meaning u_x = 0. The problem is positively homogeneous: loading in proportional
// steps gives the same states, hence one solve. Called by amontons_static; written by
// run/static/static_report.
#ifndef AMONTONS_RUN_STATIC_STATIC_SOLVE_H
#define AMONTONS_RUN_STATIC_STATIC_SOLVE_H

#include "amontons.h"
#include "contact/contact_solver.h"
#include "model/assemble.h"

typedef struct StaticSolution {
    double *displacement;   // u [dof_count]; owned, like all that follows
    double *load;   // f as prescribed, also where supports hold [dof_count]
    double *reaction;   // int B' sigma - f [dof_count]: plane, rod, supports; elsewhere rounding
    double *contact_displacement;   // [interface_count]
    double *contact_reaction;   // [interface_count] r
    uint8_t *status;   // [contact_count] ContactStatus
    uint8_t *rod_touches;   // [rod_count]
    double *work;   // [dof_count]
    Rod rod;
    double rod_way;   // where it stands: rod.displacement, or less on a spring; length
    FrictionNode *friction_nodes;   // [contact_count] Coulomb's law with mu_static; owned
    Friction friction;   // of them all
    int64_t iterations;
} StaticSolution;

// static.json, static.h5, static.vtu in `folder`.
bool static_report_write(const char *folder, const Model *model, StaticSolution *solution,
                         const StaticSummary *summary, Error *err);

#endif
