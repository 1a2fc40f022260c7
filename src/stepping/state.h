// SPDX-License-Identifier: GPL-2.0-or-later
// The state of block and interface at one time. Used by everything in stepping/ and read by run/.
#ifndef AMONTONS_STEPPING_STATE_H
#define AMONTONS_STEPPING_STATE_H

#include "base/archive.h"
#include "base/schedule.h"
#include "contact/contact_problem.h"
#include "contact/rod.h"
#include "friction/friction.h"
#include "reduction/interface_operator.h"

// The system that is stepped: the bulk, where it meets the world, and by which laws. Nothing is
// owned.
typedef struct Block {
    BulkOperator *system;
    const Interface *interface;
    const Friction *friction;
    Rod *rod;
    FrictionNode *stage_friction;   // friction->node, where laws remember: refreshed stage by
        // stage (stepping/friction_states); NULL: none does
} Block;

typedef struct State {
    double time;
    double rod_way;   // R, of a rod on a spring; 0 of one that goes where it is driven; length
    int32_t dof_count;   // of the bulk
    int32_t interface_count;
    int32_t contact_count, rod_count;
    double *displacement;   // u [dof_count]; owned, like all that follows
    double *velocity;   // v [dof_count]
    double *elastic_force;   // K u [dof_count]
    double *momentum;   // [dof_count] M v
    int32_t branch_count;   // relaxation times of the materials' branches (fem/spectrum)
    double *stretch, *pull;   // [branch_count][dof_count] e_k and K_k e_k (stepping/branches)
    double *inertia;   // [dof_count] M a of the last stage
    double *slip_rate;   // [interface_count] v on the interface, exact where it is held
    double *reaction;   // [interface_count] on the block, force/width
    double *theta;   // [contact_count, STATES_MAX] states of friction that remembers; else 0
    uint8_t *status;   // [contact_count] ContactStatus
    uint8_t *rod_touches;   // [rod_count]
} State;

// Creates a state at rest and undeformed: u = v = 0, every contact node sticking, every rod node
// apart.
bool state_create(const BulkOperator *system, const Interface *interface, State *state, Error *err);
void state_destroy(State *state);
double state_branch_energy(const State *state, int32_t k);   // e_k'K_k e_k/2
// The energy of all springs: u'K u/2, and that of each branch.
double state_elastic_energy(const State *state);
void state_copy(const State *from, State *to);   // of the same sizes

// mu, g and their derivatives at contact node i, at its pressure.
void state_friction(const State *state, const Interface *interface, const FrictionNode *node,
                    int32_t i, FrictionRates *rates);

void state_archive(State *state, Archive *archive);

// The load while the rod moves: that at t = 0 times a factor, by a table of time or of the rod's
// displacement.
typedef struct LoadCourse {
    Schedule schedule;   // count 0: the load stays
    bool by_way;   // of U; else of time
    const Rod *rod;   // whose U it follows; not owned
} LoadCourse;

// Load at `time` over that at t = 0. NULL: 1.
double load_factor(const LoadCourse *course, double time);
// Time of its next point after `time`; INFINITY: none does.
double load_next(const LoadCourse *course, double time);

#endif
