// SPDX-License-Identifier: GPL-2.0-or-later
// Laws of the slip rate alone with a formula of three numbers:
//
//   linear weakening   mu_S - (mu_S - mu_K) v/v_c  for v < v_c,  mu_K above
//                      (Otsuki and Matsukawa, Sci. Rep. 3, 1586, 2013)
//   exponential        mu_K + (mu_S - mu_K) exp(-v/v_c)
//   Coulomb            mu_S
#include "friction/laws/law.h"

#include <math.h>

// mu_S - mu_K times the factor.
static inline double drop_of(const FrictionLaw *law, double factor)
{
    return factor * law->mu_static - factor * law->mu_kinetic;
}

// Continuous at v_c, where the law has its kink.
static double linear_coefficient(const FrictionLaw *law, double factor, double speed)
{
    double critical = law->critical_velocity;
    return speed >= critical ? factor * law->mu_kinetic
                             : factor * law->mu_static - drop_of(law, factor) * speed / critical;
}

// At v_c itself 0, so that a node exactly there counts as one that weakens no more.
static double linear_slope(const FrictionLaw *law, double factor, double speed)
{
    double critical = law->critical_velocity;
    return speed < critical ? -drop_of(law, factor) / critical : 0.0;
}

const FrictionOperations friction_linear_weakening = {
    .must = "mu_static mu_kinetic critical_velocity",
    .has_drop = true,
    .is_convex = true,
    .spent = 1,
    .coefficient = linear_coefficient,
    .slope = linear_slope};

static double exponential_coefficient(const FrictionLaw *law, double factor, double speed)
{
    return factor * law->mu_kinetic + drop_of(law, factor) * exp(-speed / law->critical_velocity);
}

// It never ends but by underflow: there is no speed from which on a node is safe.
static double exponential_slope(const FrictionLaw *law, double factor, double speed)
{
    double critical = law->critical_velocity;
    return -drop_of(law, factor) / critical * exp(-speed / critical);
}

// In units of v_c: the speed at which exp(-5) of the drop is left, less than 1 %.
enum { SPENT = 5 };

const FrictionOperations friction_exponential_weakening = {
    .must = "mu_static mu_kinetic critical_velocity",
    .has_drop = true,
    .is_convex = true,
    .spent = SPENT,
    .coefficient = exponential_coefficient,
    .slope = exponential_slope};

static double coulomb_coefficient(const FrictionLaw *law, double factor, double speed)
{
    (void)speed;
    return factor * law->mu_static;
}

static double coulomb_slope(const FrictionLaw *law, double factor, double speed)
{
    (void)law, (void)factor, (void)speed;
    return 0;
}

const FrictionOperations friction_coulomb = {.must = "mu_static",
                                             .may = "mu_kinetic critical_velocity",
                                             .is_convex = true,
                                             .coefficient = coulomb_coefficient,
                                             .slope = coulomb_slope};
