// SPDX-License-Identifier: GPL-2.0-or-later
// The materials' branches (fem/spectrum) in a step: their stretches e_k and forces K_k e_k are part
// of the state. In a stage of h = gamma dt they are eliminated node by node,
//
//     e_k = (e_k* + h v)/(1 + h/tau_k),   e_k* = e_k,n + dt sum_j<i a_ij (v_j - e_k,j/tau_k),
//
// so that what is left of them in A v = rhs is h/(1 + h/tau_k) K_k, as reduction/reduced_operator
// has it. K_k v is a sum of the few S_j v, so that branches cost no products of their own. Called
// by stepping/sdirk and stepping/explicit_reference.
#ifndef AMONTONS_STEPPING_BRANCHES_H
#define AMONTONS_STEPPING_BRANCHES_H

#include "stepping/state.h"
#include "stepping/tableau.h"

typedef struct Branches {
    const BulkOperator *system;   // not owned, like the next
    const Spectrum *spectrum;
    // [SDIRK_STAGES - 1][count][dof_count] de_k/dt and K_k de_k/dt of earlier stages; owned, like
    // the next.
    double *stretch_rate, *pull_rate;
    double *image;   // [shape_count][dof_count] S_j v
    double *work;   // [dof_count]
} Branches;

bool branches_create(const BulkOperator *system, Branches *branches, Error *err);
void branches_destroy(Branches *branches);

// Puts e_k* and K_k e_k* of stage i into `to`, and takes off `rhs` what they pull at v = 0.
void branches_start_stage(const Branches *branches, double step, int32_t i, const State *from,
                          State *to, double *rhs);

// e_k and K_k e_k of the stage that ended with v, in `to`; elastic: K v, force/time. Takes off
// `force` what is proportional to v of their forces. Adds the energies that they dissipate, by the
// stage's weight in the step, to dissipated [count]; returns the power, sum_k e_k' K_k e_k/tau_k.
double branches_end_stage(Branches *branches, double step, int32_t i, const double *velocity,
                          const double *elastic, State *to, double *force, double *dissipated);

// force [dof_count] += sum_k K_k e_k, by the matrices.
void branches_add_force(Branches *branches, const State *state, double *force);

#endif
