// SPDX-License-Identifier: GPL-2.0-or-later
// Everything that depends on the kind of a law, each a switch over the kinds. Slopes are what
// Newton's derivative (contact/contact_equations) and the certificate's W (stepping/certificate)
// need; tests/unit/contact/test_friction_law.c compares them with differences of the coefficient.
#include "contact/friction_law.h"

#include <math.h>

FrictionLaw friction_constant(double mu)
{
    return (FrictionLaw){.kind = FRICTION_COULOMB, .mu_static = mu};
}

const char *friction_law_name(const FrictionLaw *law)
{
    switch (law->kind) {
#define X(symbol, name)                                                                            \
    case symbol:                                                                                   \
        return name;
        FRICTION_LAWS(X)
#undef X
    }
    return "unknown";
}

bool friction_has_drop(const FrictionLaw *law)
{
    switch (law->kind) {
    case FRICTION_LINEAR_WEAKENING:
    case FRICTION_EXPONENTIAL_WEAKENING:
        return true;
    case FRICTION_COULOMB:
        break;
    }
    return false;
}

double friction_drop(const FrictionLaw *law)
{
    return friction_has_drop(law) ? law->mu_static - law->mu_kinetic : 0;
}

double friction_slip(const FrictionLaw *law, double pressure, double height, double young)
{
    double drop = friction_drop(law);
    if (drop <= 0) drop = law->mu_static > 0 ? law->mu_static : 1;
    return drop * pressure * height / young;
}

// Continuous at v_c, where the linear law has its kink.
double friction_coefficient(const FrictionLaw *law, double speed)
{
    switch (law->kind) {
    case FRICTION_LINEAR_WEAKENING:
        if (speed >= law->critical_velocity) return law->mu_kinetic;
        return law->mu_static - friction_drop(law) * speed / law->critical_velocity;
    case FRICTION_EXPONENTIAL_WEAKENING:
        return law->mu_kinetic + friction_drop(law) * exp(-speed / law->critical_velocity);
    case FRICTION_COULOMB:
        break;
    }
    return law->mu_static;
}

// At v_c itself the linear law gives 0, so that a node exactly there counts as one that weakens no
// more.
double friction_slope(const FrictionLaw *law, double speed)
{
    switch (law->kind) {
    case FRICTION_LINEAR_WEAKENING:
        return speed < law->critical_velocity ? -friction_drop(law) / law->critical_velocity : 0.0;
    case FRICTION_EXPONENTIAL_WEAKENING:
        return -friction_drop(law) / law->critical_velocity * exp(-speed / law->critical_velocity);
    case FRICTION_COULOMB:
        break;
    }
    return 0.0;
}

double friction_kink(const FrictionLaw *law)
{
    return law->kind == FRICTION_LINEAR_WEAKENING ? law->critical_velocity : INFINITY;
}

double friction_branch(const FrictionLaw *law, bool beyond, double speed, double *slope)
{
    double kink = friction_kink(law);
    if (!isfinite(kink) || beyond == (speed >= kink)) {
        *slope = friction_slope(law, speed);
        return friction_coefficient(law, speed);
    }
    // Both sides of the linear law's kink are straight.
    double from = beyond ? kink : 0;
    *slope = friction_slope(law, from);
    return friction_coefficient(law, from) + *slope * (speed - from);
}

// Exponential weakening never ends but by underflow: there is no speed from which on a node is
// safe.
bool friction_weakens(const FrictionLaw *law, double speed)
{
    return friction_slope(law, speed) < 0.0;
}

// Of v_c: where exp(-5) is left of the exponential law's drop, under 1 %.
static const double SPENT = 5;

double friction_spent_speed(const FrictionLaw *law)
{
    switch (law->kind) {
    case FRICTION_LINEAR_WEAKENING:
        return law->critical_velocity;
    case FRICTION_EXPONENTIAL_WEAKENING:
        return SPENT * law->critical_velocity;
    case FRICTION_COULOMB:
        break;
    }
    return 0;
}

// Solves mu = mu_K + (mu_S - mu_K) phi for phi: 1 at rest, 0 from v_c on, and for the linear law
// just the paper's 1 - |v|/v_c.
double friction_contact_density(const FrictionLaw *law, double speed)
{
    double drop = friction_drop(law);
    return drop > 0 ? (friction_coefficient(law, speed) - law->mu_kinetic) / drop : 1.0;
}
