// SPDX-License-Identifier: GPL-2.0-or-later
// The explicit reference: central differences with lumped mass, nothing shared with the implicit
// path but the matrices, the friction law and the conditions of contact. An independent check of
// it, kept plain: two products with sparse matrices and one loop a step.
//
//     M (v' - v)/dt = f - K u_n - C v + r_n,   u_n+1 = u_n + dt v',   v, v' at t_n -+ dt/2
//
// The materials' branches are stepped by the midpoint rule, e' - e = dt (v' - (e + e')/(2 tau)),
// and pull with what they are at t_n (fem/spectrum), of order 2.
//
// Viscous forces lag half a step: of order 1 in dt C, with twice the stable step that an
// extrapolation of order 2 would have (stepping/stable_step gives it). Without viscosity and
// friction the scheme is of order 2. r_n and v' satisfy contact, friction and rod together; M is
// diagonal, so that is a problem of one node at a time and is solved exactly, without penalty or
// smoothing:
//
//     normal     v'_n >= -u_n/dt,  r_n >= 0, complementary         (no gap below 0 at t_n+1)
//     tangent    stick, or |v'_t| + (dt/m) mu(|v'_t|) r_n = |free v_t|,   friction against v'_t,
//                which has the direction of the free v_t
//     rod        v'_x >= (target(t_n+1) - u_n)/dt,  r_x >= 0, complementary; bonded: =
//
// Over a base (fem/floor) u and v of a contact node in these conditions are those against the floor
// node below it, and 1/m is 1/m_c + 1/m_f: r_n moves both.
//
// The states of friction are stepped by the midpoint rule, theta' = theta + dt g(|v'_t|, (theta +
// theta')/2), and friction takes the mean, too: both stand at the time of v', half a step on.
//
// A rod on a spring couples its nodes: first its own velocity is found, for which their forces and
// the spring's are in balance at t_n+1.
// Where weakening outruns the node's inertia, (dt/m) r_n |mu'| > 1, a node could both stick and
// slip; then it goes on doing what it did. Called by run/start.
#ifndef AMONTONS_STEPPING_EXPLICIT_REFERENCE_H
#define AMONTONS_STEPPING_EXPLICIT_REFERENCE_H

#include "fem/assembly.h"
#include "contact/rod.h"
#include "stepping/energy.h"
#include "stepping/state.h"

typedef struct ExplicitDef {
    const Bulk *bulk;   // of displacements of nodes
    const Mesh *mesh;   // every row of its floor is one node; NULL: the floor is rigid
    const Interface *interface;
    const Friction *friction;
    const Rod *rod;
    const LoadCourse *course;   // NULL: the load stays
    double step;   // dt, time
    FrictionNode *stage_friction;   // as in Block (stepping/state); NULL: nothing is remembered
} ExplicitDef;

typedef struct ExplicitReference {
    ExplicitDef def;   // its parts are not owned
    double *kick;   // [dof_count] dt/mass; owned, like all that follows
    double *u, *v;   // [dof_count] u at t_n, v at t_n - dt/2
    double *u_next, *v_next;   // [dof_count] the same a step later
    double *elastic, *viscous;   // [dof_count] work: K u, C v
    double *pull;   // [dof_count] forces of the materials' branches at t_n; NULL: there are none
    double *branch_work;   // [dof_count] S_j v'
    double *branch_image;   // [count][dof_count] K_k v' of each branch
    double *bound;   // [interface->count] of the last step, as in contact/contact_problem
    double rod_way;   // R at t_n, of a rod on a spring, length
    double time;   // t_n at the start
    int64_t steps;   // since then
    double factor;   // of the load in the last step
    double load_work;   // of the steps since `state` was last filled, where a course changes it
    double residual;   // of M a + C (v + v')/2 + K u = f + r in the last step, largest: the lag
} ExplicitReference;

bool explicit_reference_create(const ExplicitDef *def, ExplicitReference *scheme, Error *err);
void explicit_reference_destroy(ExplicitReference *scheme);

// Begins at `state` (u, v and a at one time; of the full mesh), which is as before afterwards, but
// for rounding over a base.
void explicit_reference_start(ExplicitReference *scheme, State *state);

// `steps` steps, and `state` at their end: u there, everything else of the last step (v', slip
// rates and reactions that belong together). The ledger's works are summed step by step
// (plastic impacts count as friction); what it misses is the scheme's own error, of order 1.
// Allocates nothing. ERROR_COMPUTE: something is no longer finite.
bool explicit_reference_advance(ExplicitReference *scheme, int64_t steps, State *state,
                                EnergyLedger *ledger, Error *err);

// Lists where the scheme is; all else follows.
void explicit_reference_archive(ExplicitReference *scheme, Archive *archive);

#endif
