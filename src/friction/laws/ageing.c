// SPDX-License-Identifier: GPL-2.0-or-later
// Ageing contacts: the linear law times a strength that grows with the age theta of contacts,
//
//     mu = m(v) (1 + beta ln(1 + theta/theta_0)),     d theta/dt = 1 - v theta/D_c,
//
// m(v) = mu_S - (mu_S - mu_K) v/v_c for v < v_c, mu_K above; state theta, time.
#include "friction/laws/law.h"

#include <math.h>

static bool make(const FrictionSource *source, FrictionLaw *law, const char **key, Error *err)
{
    (void)source, (void)key, (void)err;
    law->steepest = (law->mu_static - law->mu_kinetic) / law->critical_velocity;
    return true;
}

// Where a step that is too long would leave theta below 0 the law is that of a fresh contact; such
// a step's error is large, and it is taken shorter (stepping/sdirk).
static void find_mu(const FrictionLaw *law, double speed, double pressure, const double *state,
                    FrictionRates *rates)
{
    (void)pressure;
    double drop = law->mu_static - law->mu_kinetic, base = law->mu_kinetic, slope = 0;
    double age = *state;
    if (speed < law->critical_velocity) {
        base = law->mu_static - drop * speed / law->critical_velocity;
        slope = -drop / law->critical_velocity;
    }
    double strength = age > 0 ? 1 + law->healing * log1p(age / law->healing_time) : 1;
    double gain = age > 0 ? law->healing / (law->healing_time + age) : 0;
    rates->mu = base * strength;
    rates->mu_speed = slope * strength;
    rates->mu_state[0] = base * gain;
}

static void find_rate(const FrictionLaw *law, double speed, double pressure, const double *state,
                      FrictionRates *rates)
{
    (void)pressure;
    rates->rate[0] = 1 - speed * *state / law->slip_distance;
    rates->rate_speed[0] = -*state / law->slip_distance;
    rates->rate_state[0][0] = -speed / law->slip_distance;
}

static double rested(const FrictionLaw *law, double rest)
{
    (void)law;
    return rest;
}

static double steady(const FrictionLaw *law, double speed)
{
    return law->slip_distance / speed;
}

// Contacts grow as their strength does (Dieterich and Kilgore, Pure Appl. Geophys. 143, 1994).
static double area(const FrictionLaw *law, const double *state)
{
    return 1 + law->healing * log1p(fmax(*state, 0) / law->healing_time);
}

// A product of falling convex factors in v, ln(1 + c/(1 + x)) one of them.
const FrictionOperations friction_ageing = {
    .must = "mu_static mu_kinetic critical_velocity slip_distance healing_time healing",
    .may = "rest",
    .has_drop = true,
    .is_convex = true,
    .spent = 1,
    .make = make,
    .mu = find_mu,
    .rate = find_rate,
    .rate_is_linear = true,
    .rested = rested,
    .steady = steady,
    .area = area};
