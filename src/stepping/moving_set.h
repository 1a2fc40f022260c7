// SPDX-License-Identifier: GPL-2.0-or-later
// The interface unknowns F that a small disturbance of a state moves, and the linearised equations
// on them: tangents of slipping nodes, both unknowns of open nodes, rod nodes that do not touch or
// are soft. All else does not move. A slipping node obeys r_t = -d mu(|v_t|) r_n, d the direction
// of slip, and r_n answers to all that moves, so a disturbance v' of the velocities leaves in its
// row
//
//     (S v')_t + d mu (S v')_n - w v'_t,     w = -mu'(|v_t|) r_n
//                                            (linear law: (mu_S - mu_K) r_n / v_c below v_c).
//
// w > 0 is the node's weakening. Where the law strengthens, -w is a damper like any other, and is
// counted among what resists.
//
// In space a node that slips with the speed s along d obeys r_t = -mu(s) r_n d, d = v_t/s, and the
// derivative of that is
//
//     -mu d r_n' + (w d d' - (mu r_n/s) e e') v_t',       e across d:
//
// weakening along the slip, a damper across it, as friction turns with the slip. So matrices are
// turned into d and e of each slipping node (moving_set_turn), where both lie on the diagonal: its
// first unknown is then along the slip, with weakening and damper of the plane, its second across,
// with the damper mu r_n/s. Pressure follows slip along d only. At s = 0 that damper is infinite
// where there is friction at rest: such a node is held across, its row and column uncoupled.
//
// Where friction remembers (friction/friction.h) a disturbance theta' of its state follows
// that of the slip rate: d theta'/dt = g_v v'_t + g_theta theta', and friction changes by mu_v v'_t
// + mu_theta theta'. On exp(s t) that is a weakening that depends on s,
//
//     w(s) = -r_n (mu_v + mu_theta g_v/(s - g_theta)) = w + memory/(s + fading),
//     w = -mu_v r_n,   memory = -r_n mu_theta g_v,   fading = -g_theta:
//
// a damper or weakening as before, and a spring of negative stiffness that gives way at the rate
// `fading`. Of several states w(s) - w is that of a small system (friction/friction_response), as
// of one that grows by itself.
//
// A soft rod node that touches has a spring and a damper of its own
// (contact/rod).
// Called by stepping/certificate and stepping/growth.
#ifndef AMONTONS_STEPPING_MOVING_SET_H
#define AMONTONS_STEPPING_MOVING_SET_H

#include "stepping/state.h"

typedef struct MovingUnknown {
    int32_t unknown;   // of the interface
    int32_t normal;   // of a slipping tangent; -1: no friction here
    double friction;   // of a slipping tangent: d mu(|v_t|), in space that component of it
    double weakening;   // w >= 0, force * time / length
    double damper;   // of a soft rod node that touches: lag / softness; of a node whose friction
        // strengthens: mu' r_n; across slip: mu r_n/s; force * time / length
    bool held;   // across slip of speed 0: does not move
    double spring;   // of the same: 1 / softness, force / length
    double memory;   // of a slipping tangent: -mu_theta g_v r_n, force / length; 0: no memory
    double fading;   // -g_theta, 1/time
    int32_t node;   // of a slipping tangent with several states, or one that grows by itself, which
        // `memory` and `fading` do not say; else -1
} MovingUnknown;

typedef struct MovingSet {
    const Interface *interface;   // not owned, like the next two
    const Friction *contact_friction;
    const Rod *rod;
    MovingUnknown *list;   // [interface->count]; owned
    // The same numbers as in the list, close together for products with S. Where there is no
    // friction: the unknown itself and 0.
    int32_t *unknown, *normal;   // [interface->count]; owned
    double *friction;   // likewise
    int32_t count;   // |F|
    bool weakens;   // some weakening is above 0
    bool remembers;   // some memory is not 0
    FrictionRates *rates;   // [contact_count] of such nodes, mu_state times the pressing force;
        // NULL: no law remembers; owned
    int32_t turned_count;   // slipping nodes in space
    int32_t *turned;   // [turned_count] which of F is their first unknown; owned, like the next
    double *direction;   // [turned_count * 2] d
} MovingSet;

bool moving_set_create(const Block *block, MovingSet *set, Error *err);
void moving_set_destroy(MovingSet *set);

// Lists what `state` lets move. with_open false: open nodes are left out, as in matrices that have
// them condensed out (contact/contact_matrix).
void moving_set_find(MovingSet *set, const State *state, bool with_open);

// matrix = factor S[F,F] + keep matrix [count^2]. schur: S [interface->count^2], symmetric.
void moving_set_gather(const MovingSet *set, const double *schur, double factor, double keep,
                       double *matrix);
// Adds d mu S[n,F] to the rows of slipping tangents: the pressure that follows slip.
void moving_set_couple(const MovingSet *set, const double *schur, double *matrix);
// Both at once, of that matrix only the symmetric part, and of this the lower triangle.
void moving_set_gather_symmetric(const MovingSet *set, const double *schur, double *matrix);
// Rows and columns, or (lower) of a symmetric matrix those of the lower triangle, of slipping nodes
// in space come along their slip and across it; after which dampers and weakening are on the
// diagonal. What is held across keeps its diagonal entry alone. In the plane nothing is done.
void moving_set_turn(const MovingSet *set, bool lower, double *matrix);
// The same for a vector [count], 0 where held across, and back.
void moving_set_turn_vector(const MovingSet *set, bool back, double *vector);

// Adds dampers, and springs times `reach` (velocity to displacement, time; 0: none), to the
// diagonal.
void moving_set_add_dampers(const MovingSet *set, double reach, double *matrix);
// Subtracts the weakening at s = 1/reach, time; 0: at once, whatever is remembered.
void moving_set_subtract_weakening(const MovingSet *set, double reach, double *matrix);
// `factor` times the most that what is remembered weakens, memory Re 1/(s + fading), at any s with
// |s| >= 1/reach and Re s >= narrow |s|, 0 <= narrow < 1.
void moving_set_subtract_memory(const MovingSet *set, double reach, double narrow, double factor,
                                double *matrix);
// True if no state by itself, at held slip, grows at a real rate of 1/reach or more: W(s) has no
// pole there.
bool moving_set_decays(const MovingSet *set, double reach);
// W(s) at s = 1/reach as weakening or damper, in place of what is remembered.
void moving_set_settle(MovingSet *set, double reach);

// --- weakening over what a state withstands of it -----------------------------------------------
//
// With A(s) the matrix of the equations above made of S(s) = s M + C + K/s condensed on the
// interface,
//
//     ratio(s) = largest eigenvalue of A(s)^-1 W:     1: s is a real rate of growth,
//                                                    below 1 for all s > 0: there is none.
//
// Two real rates are born as one, where ratio(s) has a maximum, in general between two s at which
// it was computed.

// ratio(s) by powers of A^-1 W until two of them agree to `tolerance`, relative; INFINITY where
// they never do. lu, pivots: A as dense_lu leaves it. x: [count] work. 0 where nothing weakens.
double weakening_ratio(const MovingSet *set, const double *lu, const int32_t *pivots,
                       double tolerance, double *x);

// The top of the parabola through ratios at three s, each twice the one before, in log s; the
// middle one where that is not the largest. *octaves: how far from the middle s the top is.
double weakening_ratio_top(const double ratio[3], double *octaves);

#endif
