// SPDX-License-Identifier: GPL-2.0-or-later
// The law, its slope and the density it stands for, each a switch over the kinds: a new law adds a
// kind to the header, a case to the two functions below and its name to scene/keys; the solver
// asks for nothing more, contact/contact_path only whether it has a kink. DESIGN section 3 has the
// paper's linear law; the slope is what Newton's derivative (contact/contact_solver) and the
// certificate (W in DESIGN 4.5) need. tests/unit/contact/test_friction_law.c compares slopes with
// differences of the coefficient.
#include "contact/friction_law.h"

#include <math.h>

FrictionLaw friction_law_default(void)
{
    return (FrictionLaw){.kind = FRICTION_LINEAR_WEAKENING,
                         .mu_static = 0.38,
                         .mu_kinetic = 0.1,
                         .critical_velocity = 3.4e-4};
}

// mu_S - mu_K, 1: what the law loses from rest to fast slip.
static double drop(const FrictionLaw *law)
{
    return law->mu_static - law->mu_kinetic;
}

// Continuous at v_c, where the linear law has its kink. Coulomb's coefficient is mu_S at any speed.
double friction_coefficient(const FrictionLaw *law, double speed)
{
    switch (law->kind) {
    case FRICTION_LINEAR_WEAKENING:
        if (speed >= law->critical_velocity) return law->mu_kinetic;
        return law->mu_static - drop(law) * speed / law->critical_velocity;
    case FRICTION_EXPONENTIAL_WEAKENING:
        return law->mu_kinetic + drop(law) * exp(-speed / law->critical_velocity);
    case FRICTION_COULOMB:
        break;
    }
    return law->mu_static;
}

// One over a velocity. At v_c itself the linear law gives 0, so that a node exactly there counts as
// one that weakens no more.
double friction_slope(const FrictionLaw *law, double speed)
{
    switch (law->kind) {
    case FRICTION_LINEAR_WEAKENING:
        return speed < law->critical_velocity ? -drop(law) / law->critical_velocity : 0.0;
    case FRICTION_EXPONENTIAL_WEAKENING:
        return -drop(law) / law->critical_velocity * exp(-speed / law->critical_velocity);
    case FRICTION_COULOMB:
        break;
    }
    return 0.0;
}

// Exponential weakening never ends but by underflow: there is no speed from which on a node is
// safe.
bool friction_weakens(const FrictionLaw *law, double speed)
{
    return friction_slope(law, speed) < 0.0;
}

// Of v_c: where exp(-5) is left of the exponential law's drop, under 1 %.
static const double SPENT = 5;

// Where next to nothing is left of the drop, or none.
double friction_spent_speed(const FrictionLaw *law)
{
    return law->critical_velocity * (law->kind == FRICTION_EXPONENTIAL_WEAKENING ? SPENT : 1);
}

// Solves mu = mu_K + (mu_S - mu_K) phi for phi: 1 at rest, 0 from v_c on, and for the linear law
// just the paper's 1 - |v|/v_c.
double friction_contact_density(const FrictionLaw *law, double speed)
{
    if (law->kind == FRICTION_COULOMB || drop(law) <= 0) return 1.0;
    return (friction_coefficient(law, speed) - law->mu_kinetic) / drop(law);
}
