// SPDX-License-Identifier: GPL-2.0-or-later
// Friction that remembers: a contact node has a state, and
//
//     mu = mu(v, state),   d state/dt = g(v, state),   v = |slip rate| >= 0
//
//   ageing          m(v) (1 + beta ln(1 + theta/theta_0)),  d theta/dt = 1 - v theta/D_c,
//                   m the linear weakening of contact/friction_law; state theta, time
//   slip-weakening  mu_K + (mu_S - mu_K) phi,  d phi/dt = (1 - phi)/t_h - v phi/D_c;
//                   state phi, the part of strength that is there, 1
//   rate-and-state  a asinh(v/(2 V_0) exp((f_0 + b psi)/a)); state psi = ln(V_0 theta/D_c), 1
//                   ageing law  d theta/dt = 1 - v theta/D_c,
//                               d psi/dt = (V_0 exp(-psi) - v)/D_c
//                   slip law    d theta/dt = -(v theta/D_c) ln(v theta/D_c),
//                               d psi/dt = -(v/D_c) (psi + ln(v/V_0))
//                   (Dieterich, J. Geophys. Res. 84, 1979; Ruina, J. Geophys. Res. 88, 1983;
//                   regularised as by Rice, Lapusta and Ranjith, J. Mech. Phys. Solids 49, 2001)
//
// In a stage of an implicit scheme the state is eliminated node by node: it obeys
// state = from + reach g(v, state), whose one solution is a function of v. So what the contact
// problem sees, mu(v, state(v)), is a law of speed alone, of which `from` and `reach` are numbers
// (docs/method.md, section 3). Called by contact/friction_law alone.
#ifndef AMONTONS_CONTACT_FRICTION_MEMORY_H
#define AMONTONS_CONTACT_FRICTION_MEMORY_H

#include <stdbool.h>
#include <stdint.h>

typedef enum MemoryKind { MEMORY_AGEING, MEMORY_SLIP_WEAKENING, MEMORY_RATE_STATE } MemoryKind;

typedef struct FrictionMemory {
    MemoryKind kind;
    double mu_static, mu_kinetic;   // of ageing at theta = 0; of rate-and-state about what the
        // slowest and the fastest slip meet, a scale; 1
    double critical_velocity;   // v_c of ageing, velocity
    double slip_distance;   // D_c, length
    double healing_time;   // theta_0 or t_h, time
    double healing;   // beta; b of rate-and-state; 1
    double direct;   // a, 1
    double reference;   // f_0, 1
    double reference_velocity;   // V_0, velocity
    bool slip_law;   // of rate-and-state: how its state evolves
    double start;   // the state when the rod begins to move
    double from, reach;   // of the stage under way: see above; reach: time; 0: the state is `from`
} FrictionMemory;

// mu and g at a speed and a state, with their derivatives.
typedef struct FrictionRates {
    double mu, mu_speed, mu_state;   // 1; one over a velocity; one over a state
    double rate, rate_speed, rate_state;   // g, and its derivatives
} FrictionRates;

FrictionRates memory_rates(const FrictionMemory *memory, double speed, double state);

// At the end of the stage under way.
double memory_state(const FrictionMemory *memory, double speed);
// mu there, and its slope along the stage: mu_v + mu_theta reach g_v/(1 - reach g_theta).
double memory_coefficient(const FrictionMemory *memory, double speed, double *slope);

// Of rate-and-state: the velocity to which a step of Newton's method leads that is taken in mu
// instead of in v (v_s of the present state kept), so that friction is nearly linear along it.
double memory_follow(const FrictionMemory *memory, double velocity, double step);

// The state of contacts that rested for `rest` > 0 since they were made, and of steady slip.
double memory_rested(const FrictionMemory *memory, double rest);
double memory_steady(const FrictionMemory *memory, double speed);

// As people read it: theta, time; of slip-weakening phi.
double memory_shown(const FrictionMemory *memory, double state);

// The weakest slip rate at which next to nothing of mu(v) of the stage is left to fall, velocity.
double memory_spent_speed(const FrictionMemory *memory);

#endif
