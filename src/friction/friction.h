// SPDX-License-Identifier: GPL-2.0-or-later
// Friction of a contact: |tau| <= mu p at each node.
//
//   FrictionLaw    a law and its numbers (friction/laws/law.h); a contact has one, or a short list
//   FrictionNode   friction at one node: which law holds there, its factor, the stage under way
//   Friction       friction of a contact: the nodes, and scales of them all
//
// A number such as v_c comes from the map `friction` of a scene (scene/keys). scene/friction_law
// hands it to friction_make, which completes the law by its table of operations;
// model/model takes it for the whole contact (friction_everywhere); where laws differ from place
// to place or remember, model/contact_nodes gives each node its own. run/start hands the model's
// Friction to the stepper (stepping/sdirk), which hands it to each contact problem
// (contact/contact_problem). contact/ and stepping/ ask a node
// (friction_at) for mu and its slope, which the table answers (friction/laws).
//
// In a stage of an implicit scheme the states are eliminated node by node: they obey
// state = from + reach g(v, state), and so are functions of v. What the contact problem sees,
// mu(v, state(v)), is a law of speed alone, of which `from` and `reach` are numbers
// (docs/method.md, section 15).
#ifndef AMONTONS_FRICTION_FRICTION_H
#define AMONTONS_FRICTION_FRICTION_H

#include "friction/laws/law.h"

// Friction at a contact node. Nothing is owned.
typedef struct FrictionNode {
    const FrictionLaw *law;   // an entry of the contact's list
    double factor;   // on mu at every speed, 1
    // The stage under way, of a law that remembers.
    double from[STATES_MAX], reach;   // see above; reach: time; 0: the states are `from`
    double pressure;   // p, stress
    // Another clock, by friction_paced; 0: none.
    double pace, mu_pace;   // by how much faster the states run, and by how much slower a slip
        // meets this mu; 1
} FrictionNode;

// Friction of a contact. Nothing is owned.
typedef struct Friction {
    FrictionNode whole;   // friction at every node where `node` is NULL; else at the node with the
        // largest drop
    FrictionNode *node;   // [contact_count] where nodes differ, or laws remember; else NULL
    double mu_static, mu_kinetic;   // the largest mu_S, and less the largest drop, 1
    double critical_velocity;   // the least v_c of nodes that weaken, velocity
    double drop;   // the largest drop (friction_drop), 1
} Friction;

// --- nodes and contacts -------------------------------------------------------------------------

// `factor` >= 0 times the law, at the start.
FrictionNode friction_node(const FrictionLaw *law, double factor);

// Coulomb's law with this coefficient, at every node; 0: no friction.
FrictionNode friction_constant(double mu);

// The same friction at every node.
Friction friction_everywhere(FrictionNode node);

// Friction of the nodes [count], which must outlive it.
Friction friction_of_nodes(FrictionNode *node, int32_t count);

static inline const FrictionNode *friction_at(const Friction *friction, int32_t i)
{
    return friction->node ? &friction->node[i] : &friction->whole;
}

// Some node has a law that remembers; one that creeps; and the largest number of states of a node.
bool friction_remembers(const Friction *friction, int32_t count);
bool friction_creeps(const Friction *friction, int32_t count);
int32_t friction_states(const Friction *friction, int32_t count);

// --- the coefficient; in a stage, of a law that remembers ---------------------------------------

// mu at this speed, and d mu/d speed, one over a velocity: below 0 where the law weakens, above 0
// where it strengthens; at a kink the slope beyond it.
double friction_coefficient(const FrictionNode *node, double speed);
double friction_slope(const FrictionNode *node, double speed);

// mu_K there.
static inline double friction_kinetic(const FrictionNode *node)
{
    return node->factor * node->law->mu_kinetic;
}

// The largest loss of mu from a speed to a faster one: mu_S - mu_K where mu is nowhere above
// mu(0); 0 where nothing weakens.
double friction_drop(const FrictionNode *node);

// The largest weakening -mu' of all speeds, one over a velocity.
double friction_steepest(const FrictionNode *node);

// Still weakening at this speed: a faster or, with states, a further slip meets less friction.
bool friction_weakens(const FrictionNode *node, double speed);

// With the states held, a law that is not 0 at rest meets less friction at some faster slip.
bool friction_weakens_at_once(const FrictionNode *node);

// Speed from about which on next to nothing weakens any more, velocity; 0 where nothing weakens.
double friction_spent_speed(const FrictionNode *node);

// phi = max(0, 1 - |v|/v_c), the density of real contacts that hold (the paper's Figure 1d); from
// the coefficient for the other laws: (mu - mu_K) / (mu_S - mu_K), 1 from mu_S on.
double friction_contact_density(const FrictionNode *node, double speed);

// Area of the real contacts over that at the start, when the rod begins to move: by the states
// where the law has a measure of its own, else the density at this speed.
bool friction_has_area(const FrictionNode *node);
double friction_contact_area(const FrictionNode *node, double speed, const double *state);

// The slip that the drop can drive under a mean pressure, drop * pressure * height / young, length;
// mu_S stands for the drop where nothing weakens, 1 without any friction.
double friction_slip(const Friction *friction, double pressure, double height, double young);

// --- states: each function may be asked of a law without, which has none ------------------------

// Begins a stage: the states obey state = from + reach g(v, state).
void friction_set_stage(FrictionNode *node, const double *from, double reach);

// Sets the pressure of the stage, of a law that asks for it; returns by how much mu at this speed
// changes with that, 1.
double friction_set_pressure(FrictionNode *node, double pressure, double speed);

// The states [states] at the end of the stage; NaN where its equation was not solved.
void friction_state(const FrictionNode *node, double speed, double *state);

// mu and g at a speed and states; the pressure is that of the stage, or given.
void friction_rates(const FrictionNode *node, double speed, const double *state,
                    FrictionRates *rates);
void friction_rates_pressed(const FrictionNode *node, double pressure, double speed,
                            const double *state, FrictionRates *rates);

// d mu/d speed with the states held, at the end of the stage.
double friction_direct_slope(const FrictionNode *node, double speed);

// x [states] becomes (1 - reach g_theta)^-1 x. Returns false where that is singular.
bool friction_solve_states(const FrictionRates *rates, double reach, double *x);

// The part of the states in d mu/d speed over a stage: mu_theta (1 - reach g_theta)^-1 reach g_v.
double friction_feedback(const FrictionRates *rates, double reach);

// Finds, for a law that creeps, the velocity [count] to which a step of Newton's method leads that
// is taken in friction instead of in v: in asinh(|v|/v_s) v/|v|, v_s that of an asinh with mu and
// mu_v of the law at its present states, so that friction is nearly linear along it. count: 1, in
// space 2.
void friction_follow(const FrictionNode *node, int32_t count, const double *velocity,
                     const double *step, double *next);

// The states when the rod begins to move; and the value of state k as it is printed.
void friction_start_state(const FrictionNode *node, double *state);
double friction_shown_state(const FrictionNode *node, int32_t k, double state);

// The same node on another clock: at a slip rate `pace` v its states run `pace` times as fast as
// they do at v, and so are the same. A block that is led through its states slower than it is
// driven (study/stability) remembers by it as its own drive would have it. mu is that of v, too,
// but where it falls with slip rate, whatever is remembered: on a slow path it is that of rest.
FrictionNode friction_paced(const FrictionNode *node, double pace);

// --- laws ---------------------------------------------------------------------------------------

const char *friction_law_name(const FrictionLaw *law);   // "unknown" for a kind that there is not

// A table, a formula or a plug-in.
bool friction_is_own(const FrictionLaw *law);

// It has mu_K and v_c; else they mean nothing.
bool friction_has_drop(const FrictionLaw *law);

// The drop of a node with this law.
double friction_law_drop(const FrictionLaw *law);

// mu' never falls: w + a mu(w), a > 0, has no more than two roots.
bool friction_is_convex(const FrictionLaw *law);

// The state of contacts that rested for `rest` > 0 since they were made, of a built-in law.
double friction_rested(const FrictionLaw *law, double rest);

// Name and unit of a state, as they are printed; the states of a formula have the scene's names.
const char *friction_state_name(const FrictionLaw *law);
const char *friction_state_unit(const FrictionLaw *law);

#endif
