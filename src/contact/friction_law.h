// SPDX-License-Identifier: GPL-2.0-or-later
// The local friction law |tau| <= mu(v) p: THE replaceable file. A law is a coefficient that falls
// (or stays) as slip gets faster, continuous, with mu(0) the static threshold; stick is set-valued.
//
//   linear weakening   mu_S - (mu_S - mu_K) |v| / v_c  for |v| < v_c,  mu_K above   (the paper)
//   exponential        mu_K + (mu_S - mu_K) exp(-|v| / v_c)
//   Coulomb            mu_S
//
// Used by contact/contact_solver (values and slopes), contact/contact_check (values) and
// stepping/certificate (the steepest slope).
#ifndef AMONTONS_CONTACT_FRICTION_LAW_H
#define AMONTONS_CONTACT_FRICTION_LAW_H

#include <stdbool.h>

typedef enum FrictionKind {
    FRICTION_LINEAR_WEAKENING,
    FRICTION_EXPONENTIAL_WEAKENING,
    FRICTION_COULOMB
} FrictionKind;

typedef struct FrictionLaw {
    FrictionKind kind;
    double mu_static;   // mu_S, 1
    double mu_kinetic;   // mu_K <= mu_S, 1; unused by Coulomb
    double critical_velocity;   // v_c > 0, velocity; unused by Coulomb
} FrictionLaw;

// Parameter set A of the paper.
FrictionLaw friction_law_default(void);

// speed: |slip rate| >= 0.
double friction_coefficient(const FrictionLaw *law, double speed);

// d mu / d speed, <= 0; at the kink of the linear law the slope beyond it.
double friction_slope(const FrictionLaw *law, double speed);

// Still weakening at this speed: a faster slip meets less friction.
bool friction_weakens(const FrictionLaw *law, double speed);

// From about this speed on next to nothing weakens any more (linear law: nothing), velocity.
double friction_spent_speed(const FrictionLaw *law);

// phi = max(0, 1 - |v|/v_c), the density of real contacts that hold (the paper's Figure 1d); from
// the coefficient for the other laws: (mu - mu_K) / (mu_S - mu_K), and 1 where nothing weakens.
double friction_contact_density(const FrictionLaw *law, double speed);

#endif
