// SPDX-License-Identifier: GPL-2.0-or-later
// States of friction that remembers (friction/friction.h), stepped by the scheme's own tableau
// and eliminated node by node: stage i of a step dt has
//
//     theta_i = theta_i* + gamma dt g(|v_i|, theta_i),   theta_i* = theta_n + dt sum_j<i a_ij g_j
//
// as displacements do (stepping/sdirk), and what is left for the contact problem is a law of speed
// at each node. An open node's state goes on with its own tangential velocity. Called by
// stepping/sdirk, stepping/step_control and run/start.
#ifndef AMONTONS_STEPPING_FRICTION_STATES_H
#define AMONTONS_STEPPING_FRICTION_STATES_H

#include "stepping/state.h"
#include "stepping/tableau.h"

typedef struct FrictionStates {
    FrictionNode *node;   // [contact_count] not owned; NULL: nothing is remembered
    const Interface *interface;   // not owned
    bool act;   // some state changes mu: not where friction heals by nothing
    bool frozen;   // states stay as they are: the block settles, and no time passes for them
    double slip_per_mu;   // that drives it: an error of mu counts as one of u so large, length
    double *rate;   // [SDIRK_STAGES + 1, contact_count, STATES_MAX] g at the start of the
        // step and in its stages; owned
    double
        *mu_state;   // [contact_count, STATES_MAX] mu_theta at the end of the last of them; owned
} FrictionStates;

bool friction_states_create(const Block *block, FrictionStates *states, Error *err);
void friction_states_destroy(FrictionStates *states);

// Puts the states at the moment when the rod begins to move into `state`; the laws are those of it.
void friction_states_reset(FrictionStates *states, State *state);

// The functions stand in the order in which they are called in a step. Stage 0 begins with
// friction_states_begin.
void friction_states_begin(FrictionStates *states, const State *from);
void friction_states_start_stage(FrictionStates *states, double step, int32_t stage,
                                 const State *from);
// Laws that ask for pressure are handed that of the reactions at hand. true: mu has changed by more
// than rounding, and the contact problem has to be solved once more.
bool friction_states_press(FrictionStates *states, const double *velocity, const double *reaction);
// `to` has the velocities and reactions of the stage; its states go there, too.
void friction_states_end_stage(FrictionStates *states, int32_t stage, State *to);

// The largest error of mu that the local error of a state makes, as a length; all stages are over.
double friction_states_error(const FrictionStates *states, double step);

// The stages under way: the judge asks for the last one.
// Whether mu, not negative, and states are numbers at each node in the stage under way, `at` these
// slip rates; else *speed and *mu say what they are at one where they are not.
bool friction_states_hold(const FrictionStates *states, const double *at, double *speed,
                          double *mu);

void friction_states_archive(FrictionStates *states, Archive *archive);

#endif
