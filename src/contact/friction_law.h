// SPDX-License-Identifier: GPL-2.0-or-later
// The local friction law |tau| <= mu(v) p: THE replaceable file. A law is a coefficient that falls
// (or stays) as slip gets faster, continuous, with mu(0) the static threshold; stick is set-valued.
//
//   linear weakening   mu_S - (mu_S - mu_K) |v| / v_c  for |v| < v_c,  mu_K above
//                      (Otsuki and Matsukawa, Sci. Rep. 3, 1586, 2013)
//   exponential        mu_K + (mu_S - mu_K) exp(-|v| / v_c)
//   Coulomb            mu_S
//
// A new law is a line of FRICTION_LAWS and its cases in friction_law.c: nobody else asks for the
// kind, but through the functions below.
#ifndef AMONTONS_CONTACT_FRICTION_LAW_H
#define AMONTONS_CONTACT_FRICTION_LAW_H

#include <stdbool.h>

// symbol, name in a scene
#define FRICTION_LAWS(X)                                                                           \
    X(FRICTION_LINEAR_WEAKENING, "linear-weakening")                                               \
    X(FRICTION_EXPONENTIAL_WEAKENING, "exponential-weakening")                                     \
    X(FRICTION_COULOMB, "coulomb")

typedef enum FrictionKind {
#define X(symbol, name) symbol,
    FRICTION_LAWS(X)
#undef X
} FrictionKind;

typedef struct FrictionLaw {
    FrictionKind kind;
    double mu_static;   // mu_S, 1
    double mu_kinetic;   // mu_K <= mu_S, 1; of laws that weaken
    double critical_velocity;   // v_c > 0, velocity; of laws that weaken
} FrictionLaw;

// mu at every speed; 0: no friction.
FrictionLaw friction_constant(double mu);

const char *friction_law_name(const FrictionLaw *law);   // "unknown" for a kind that there is not

// The law has mu_K and v_c; else they mean nothing.
bool friction_has_drop(const FrictionLaw *law);

// mu_S - mu_K, 1: what the law loses from rest to fast slip; 0 where nothing weakens.
double friction_drop(const FrictionLaw *law);

// The slip that the drop can drive under a mean pressure, drop * pressure * height / young, length;
// mu_S stands for the drop where nothing weakens, 1 without any friction.
double friction_slip(const FrictionLaw *law, double pressure, double height, double young);

// speed, here and below: |slip rate| >= 0.
double friction_coefficient(const FrictionLaw *law, double speed);

// d mu / d speed, <= 0, one over a velocity; at a kink the slope beyond it.
double friction_slope(const FrictionLaw *law, double speed);

// The speed at which the slope jumps; INFINITY: nowhere.
double friction_kink(const FrictionLaw *law);

// mu and its slope on one side of the kink, continued smoothly to any speed.
double friction_branch(const FrictionLaw *law, bool beyond, double speed, double *slope);

// Still weakening at this speed: a faster slip meets less friction.
bool friction_weakens(const FrictionLaw *law, double speed);

// From about this speed on next to nothing weakens any more (linear law: nothing), velocity; 0
// where nothing weakens.
double friction_spent_speed(const FrictionLaw *law);

// phi = max(0, 1 - |v|/v_c), the density of real contacts that hold (the paper's Figure 1d); from
// the coefficient for the other laws: (mu - mu_K) / (mu_S - mu_K), and 1 where nothing weakens.
double friction_contact_density(const FrictionLaw *law, double speed);

#endif
