// SPDX-License-Identifier: GPL-2.0-or-later
// Strength that slip takes away and rest gives back:
//
//     mu = mu_K + (mu_S - mu_K) phi,     d phi/dt = (1 - phi)/t_h - v phi/D_c,
//
// state phi, the part of strength that is there, 1.
#include "friction/laws/law.h"

#include <math.h>

// v_c is the slip rate at which steady slip has lost half of its strength.
static bool make(const FrictionSource *source, FrictionLaw *law, const char **key, Error *err)
{
    (void)source, (void)key, (void)err;
    law->critical_velocity = law->slip_distance / law->healing_time;
    return true;
}

static void find_mu(const FrictionLaw *law, double speed, double pressure, const double *state,
                    FrictionRates *rates)
{
    (void)speed, (void)pressure;
    double drop = law->mu_static - law->mu_kinetic;
    rates->mu = law->mu_kinetic + drop * fmax(*state, 0);
    rates->mu_speed = 0;
    rates->mu_state[0] = *state > 0 ? drop : 0;
}

static void find_rate(const FrictionLaw *law, double speed, double pressure, const double *state,
                      FrictionRates *rates)
{
    (void)pressure;
    double heals = 1 / law->healing_time, slips = 1 / law->slip_distance;
    rates->rate[0] = (1 - *state) * heals - speed * *state * slips;
    rates->rate_speed[0] = -*state * slips;
    rates->rate_state[0][0] = -heals - speed * slips;
}

static double rested(const FrictionLaw *law, double rest)
{
    return -expm1(-rest / law->healing_time);
}

static double steady(const FrictionLaw *law, double speed)
{
    return 1 / (1 + speed * law->healing_time / law->slip_distance);
}

static double area(const FrictionLaw *law, const double *state)
{
    (void)law;
    return fmax(*state, 0);
}

const FrictionOperations friction_slip_weakening = {
    .must = "mu_static mu_kinetic slip_distance healing_time",
    .may = "rest",
    .has_drop = true,
    .is_convex = true,
    .make = make,
    .mu = find_mu,
    .rate = find_rate,
    .rate_is_linear = true,
    .rested = rested,
    .steady = steady,
    .area = area,
    .state_name = "phi",
    .state_unit = "1"};
