// SPDX-License-Identifier: GPL-2.0-or-later
// Friction that remembers: a contact node has states, and
//
//     mu = mu(v, states),   d state/dt = g(v, states),   v = |slip rate| >= 0
//
//   ageing          m(v) (1 + beta ln(1 + theta/theta_0)),  d theta/dt = 1 - v theta/D_c,
//                   m the linear weakening of friction/friction_law; state theta, time
//   slip-weakening  mu_K + (mu_S - mu_K) phi,  d phi/dt = (1 - phi)/t_h - v phi/D_c;
//                   state phi, the part of strength that is there, 1
//   rate-and-state  a asinh(v/(2 V_0) exp((f_0 + b psi)/a)); state psi = ln(V_0 theta/D_c), 1
//                   ageing law  d theta/dt = 1 - v theta/D_c,
//                               d psi/dt = (V_0 exp(-psi) - v)/D_c
//                   slip law    d theta/dt = -(v theta/D_c) ln(v theta/D_c),
//                               d psi/dt = -(v/D_c) (psi + ln(v/V_0))
//                   (Dieterich, J. Geophys. Res. 84, 1979; Ruina, J. Geophys. Res. 88, 1983;
//                   regularised as by Rice, Lapusta and Ranjith, J. Mech. Phys. Solids 49, 2001)
//   formulas        mu and a rate for each state, of v, p and all states
//   plug-in         the same by functions of a shared object (amontons_friction.h)
//
// A law is a row: functions that give mu and g with their derivatives. All else is the same for
// all. In a stage of an implicit scheme the states are eliminated node by node: they obey
// state = from + reach g(v, state), and so are functions of v. What the contact problem sees,
// mu(v, state(v)), is a law of speed alone, of which `from` and `reach` are numbers
// (docs/method.md, section 15). Called by friction/friction_law and friction/friction_state.
#ifndef AMONTONS_FRICTION_FRICTION_MEMORY_H
#define AMONTONS_FRICTION_FRICTION_MEMORY_H

#include "base/formula.h"
#include "friction/friction_plugin.h"

enum { STATES_MAX = AMONTONS_FRICTION_STATES_MAX };   // of a node

typedef enum MemoryKind {
    MEMORY_AGEING,
    MEMORY_SLIP_WEAKENING,
    MEMORY_RATE_STATE,
    MEMORY_FORMULAS,
    MEMORY_PLUGIN,
    MEMORY_PACED   // any of these on another clock (friction/friction_pace)
} MemoryKind;

// mu and g at a speed and a state, with their derivatives; of entries as many as there are states.
typedef AmontonsFrictionRates FrictionRates;

typedef struct FrictionMemory {
    MemoryKind kind;
    int32_t states;   // how many
    bool creeps;   // mu is 0 at rest, whatever the states are: no node ever sticks
    double factor;   // on mu, 1
    double mu_static, mu_kinetic;   // of ageing at theta = 0; of rate-and-state about what the
        // slowest and the fastest slip meet, a scale, as with formulas and plug-ins; 1
    double critical_velocity;   // v_c of ageing, velocity
    double slip_distance;   // D_c, length
    double healing_time;   // theta_0 or t_h, time
    double healing;   // beta; b of rate-and-state; 1
    double direct;   // a, 1
    double reference;   // f_0: mu of steady slip, 1
    double reference_velocity;   // V_0, velocity
    bool slip_law;   // of rate-and-state: how its state evolves
    double start[STATES_MAX];   // the states when the rod begins to move
    double from[STATES_MAX], reach;   // of the stage under way: see above; reach: time; 0: the
        // states are `from`
    double pressure;   // p of the stage, stress; of formulas and plug-ins
    bool feels_pressure;   // mu or a rate depends on it
    MemoryKind paced;   // of MEMORY_PACED: which law it is
    double pace, mu_pace;   // by how much faster its states run, and its mu; 1
    union {
        struct {
            Formula formula;   // of v, the states and p: mu, then the rates, one behind the other
            int32_t ends[STATES_MAX + 2];   // where each begins, and the last ends
        };
        FrictionPlugin plugin;
    };
} FrictionMemory;

void memory_rates(const FrictionMemory *memory, double speed, const double *state,
                  FrictionRates *rates);

// At the end of the stage under way; NaN where the equation of the stage was not solved.
void memory_state(const FrictionMemory *memory, double speed, double *state);
// mu there, and its slope along the stage: mu_v + mu_theta (1 - reach g_theta)^-1 reach g_v.
double memory_coefficient(const FrictionMemory *memory, double speed, double *slope);
// The term that the states add to mu_v there.
double memory_feedback(const FrictionRates *rates, double reach);
// x [states] becomes (1 - reach g_theta)^-1 x. false: singular.
bool memory_solve_states(const FrictionRates *rates, double reach, double *x);

// For a law that creeps: the velocity [count] to which a step of Newton's method leads that is
// taken in friction instead of in v: in asinh(|v|/v_s) v/|v|, v_s that of an asinh with mu and mu_v
// of the law at its present states, so that friction is nearly linear along it. count: 1, in space
// 2.
void memory_follow(const FrictionMemory *memory, int32_t count, const double *velocity,
                   const double *step, double *next);

// The state of contacts that rested for `rest` > 0 since they were made, and of steady slip; of the
// laws that are built in.
double memory_rested(const FrictionMemory *memory, double rest);
double memory_steady(const FrictionMemory *memory, double speed);

// As people read it: theta of rate-and-state, time; else as it is.
double memory_shown(const FrictionMemory *memory, double state);

// The weakest slip rate at which next to nothing of mu(v) of the stage is left to fall, velocity.
double memory_spent_speed(const FrictionMemory *memory);

#endif
