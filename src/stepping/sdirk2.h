// SPDX-License-Identifier: GPL-2.0-or-later
// One step of the two-stage, stiffly accurate, L-stable SDIRK of order 2 (Alexander, SIAM J. Numer.
// Anal. 14, 1977), gamma = 1 - 1/sqrt 2, on M v' + C v + K u = f + r, u' = v, in velocities:
//
//     c1 = gamma | gamma              stage j:  A v_j = M w_j/(gamma dt) + f - K u_j* + r_j
//     c2 = 1     | 1-gamma  gamma               A     = M/(gamma dt) + C + gamma dt K
//     -----------+---------------
//                | 1-gamma  gamma     u_1* = u_n                      w_1 = v_n
//                                     u_2* = u_n + (1-gamma) dt v_1   w_2 = v_n + (1-gamma) dt a_1
//
// with a_1 = (v_1 - v_n)/(gamma dt). Contact, friction and rod hold at each stage, hence at the end
// of the step. Called by stepping/step_control.
#ifndef AMONTONS_STEPPING_SDIRK2_H
#define AMONTONS_STEPPING_SDIRK2_H

#include "contact/contact_solver.h"
#include "stepping/energy.h"
#include "stepping/ladder.h"

typedef struct Sdirk2 {
    BulkOperator *system;   // not owned, like the next four
    Ladder *ladder;
    const Interface *interface;
    const FrictionLaw *law;
    Rod *rod;
    ContactSolver solver;   // owned, like all that follows
    double *rhs, *force, *viscous;   // [dof_count] work
    double *v1, *predictor;   // [dof_count] work: v_1; u_j*
    double *g, *bound;   // [interface_count] work; bound: of the last stage
    double reach;   // gamma dt of the last stage, time
    double *stage_velocity, *stage_reaction;   // [interface_count] work: of stage 1
    int64_t steps;   // tried
} Sdirk2;

typedef struct StepOutcome {
    bool solved;   // false: a contact problem had no solution; `to` has no meaning
    double error;   // size of the estimated local error of u (bulk_operator_size), length
    double residual;   // |M a + C v + K u - f - r| at the end, largest component, force/width; only
        // every 32nd step is looked at, the others say 0
    StagePower power[2];   // of the stages
    double load_work;   // of the step
} StepOutcome;

bool sdirk2_create(const Block *block, Ladder *ladder, Sdirk2 *scheme, Error *err);
void sdirk2_destroy(Sdirk2 *scheme);

// From `from` with rung k of the ladder to `to`. false: a library failed (err says what); an
// unsolved contact problem is no error but an outcome.
bool sdirk2_step(Sdirk2 *scheme, int32_t k, const State *from, State *to, StepOutcome *outcome,
                 Error *err);

// The step's weights of the stages: 1 - gamma and gamma.
void sdirk2_add_energy(const StepOutcome *outcome, double step, EnergyLedger *ledger);

#endif
