// SPDX-License-Identifier: GPL-2.0-or-later
// One step of a singly diagonally implicit, stiffly accurate Runge-Kutta scheme (stepping/tableau;
// Hairer and Wanner, Solving ODEs II, IV.6) on M v' + C v + K u = f + r, u' = v, in velocities:
//
//     stage i:   A v_i = M w_i/(gamma dt) + f - K u_i* + r_i,   A = M/(gamma dt) + C + gamma dt K
//                u_i* = u_n + dt sum_j<i a_ij v_j
//                w_i  = v_n + dt sum_j<i a_ij a_j,              a_j = (v_j - w_j)/(gamma dt)
//
// Branches of the materials are eliminated (stepping/branches): A has a part of them, too.
// Contact, friction and rod hold at each stage, hence at the end of the step, which is the last
// stage. A rod on a spring has no mass: its way R follows as u does, R' = v_R (reduction/machine).
// Called by stepping/step_control.
#ifndef AMONTONS_STEPPING_SDIRK_H
#define AMONTONS_STEPPING_SDIRK_H

#include "contact/contact_solver.h"
#include "stepping/branches.h"
#include "stepping/energy.h"
#include "stepping/friction_states.h"
#include "stepping/half_step.h"
#include "stepping/dt_levels.h"
#include "stepping/state.h"
#include "stepping/tableau.h"

typedef struct Sdirk {
    BulkOperator *system;   // not owned, like the next four
    DtLevels *dt_levels;
    const Interface *interface;
    const Friction *friction;
    Rod *rod;
    const LoadCourse *course;   // set once the rod moves; NULL: the load stays; not owned
    HalfStep *half;   // solves contact where `part` is the symmetric one; not owned
    ContactPart part;   // of the contact that is solved: the whole or the symmetric part
    bool antisymmetric_acts;   // beside the symmetric part this one is stepped along ...
    ContactMatrix *antisymmetric;   // ... with this matrix; NULL: it is not; not owned
    bool symmetric_alone;   // the bulk's antisymmetric part is rounding and rests in this step
    ContactSolver solver;   // of the whole; its counters are of all; owned, like all that follows
    Branches branches;   // of the materials; nothing where none has any
    FrictionStates memory;   // of friction; nothing where none remembers
    double *rhs, *force, *viscous;   // [dof_count] work
    double *predictor;   // [dof_count] work: u_i*
    double *g, *bound;   // [interface_count] work; bound: of the last stage
    double reach;   // gamma dt of the last stage, time
    // All stages but the last: v_i and dt M a_i [stages - 1, dof_count], r_i [stages - 1,
    // interface_count].
    double *stage_velocity, *stage_impulse, *stage_reaction;
    double *stage_elastic;   // [stages, dof_count] K v_i
    double rod_start;   // work: R* of the stage, where a rod on a spring would be without velocity
    double rod_rate[SDIRK_STAGES];   // v_R of the stages, velocity
    int64_t steps;   // tried
} Sdirk;

typedef struct StepOutcome {
    bool solved;   // false: a contact problem had no solution; `to` has no meaning
    bool asymmetric;   // because it was to be halved and is not its own mirror image
    double error;   // size of the estimated local error of u (bulk_operator_size), or of what
        // friction remembers, if that is larger; length
    double residual;   // |M a + C v + K u - f - r| at the end, largest component, force/width; only
        // every 32nd step is looked at, the others say 0
    StagePower power[SDIRK_STAGES];   // of the stages
    double load_work;   // of the step
    double relaxed[SPECTRUM_TIMES_MAX];   // by branches of each relaxation time, energy
} StepOutcome;

bool sdirk_create(const Block *block, DtLevels *dt_levels, Sdirk *scheme, Error *err);
void sdirk_destroy(Sdirk *scheme);

// Steps from `from` with level k of dt to `to`. Returns false where a library failed (err says
// what); an unsolved contact problem is no error but an outcome.
bool sdirk_step(Sdirk *scheme, int32_t k, const State *from, State *to, StepOutcome *outcome,
                Error *err);

// Powers of the stages by the step's own weights.
void sdirk_add_energy(const Sdirk *scheme, const StepOutcome *outcome, double step,
                      EnergyLedger *ledger);

// Writes or reads all that outlives a step: its bounds, by which it is judged, and counters. The
// rod is another's.
void sdirk_archive(Sdirk *scheme, Archive *archive);

#endif
