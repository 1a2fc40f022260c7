// SPDX-License-Identifier: GPL-2.0-or-later
#include "contact/friction_law.h"

#include <math.h>

FrictionLaw friction_law_default(void)
{
    return (FrictionLaw){.kind = FRICTION_LINEAR_WEAKENING,
                         .mu_static = 0.38,
                         .mu_kinetic = 0.1,
                         .critical_velocity = 3.4e-4};
}

static double drop(const FrictionLaw *law)
{
    return law->mu_static - law->mu_kinetic;
}

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

bool friction_weakens(const FrictionLaw *law, double speed)
{
    return friction_slope(law, speed) < 0.0;
}

double friction_contact_density(const FrictionLaw *law, double speed)
{
    if (law->kind == FRICTION_COULOMB || drop(law) <= 0) return 1.0;
    return (friction_coefficient(law, speed) - law->mu_kinetic) / drop(law);
}
