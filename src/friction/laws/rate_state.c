// SPDX-License-Identifier: GPL-2.0-or-later
// Rate-and-state friction (Dieterich, J. Geophys. Res. 84, 1979; Ruina, J. Geophys. Res. 88, 1983;
// regularised as by Rice, Lapusta and Ranjith, J. Mech. Phys. Solids 49, 2001):
//
//     mu = a asinh(v/(2 V_0) exp((f_0 + b psi)/a)),     psi = ln(V_0 theta/D_c),
//     ageing law  d theta/dt = 1 - v theta/D_c,
//                 d psi/dt = (V_0 exp(-psi) - v)/D_c
//     slip law    d theta/dt = -(v theta/D_c) ln(v theta/D_c),
//                 d psi/dt = -(v/D_c) (psi + ln(v/V_0))
//
// The state that is stepped is psi, 1; theta, time, is shown. mu is 0 at rest: nothing ever sticks.
#include "friction/laws/law.h"

#include <math.h>

static const double EXPONENT_MAX = 690;   // exp of it is finite
// ln of it is finite: at rest the slip law keeps its state.
static const double LEAST_SPEED = 1e-300;

// Scales for a law without a coefficient at rest and without a limit velocity: mu at the reference
// velocity, raised by the healing that the contacts have at the start, and mu of steady slip at the
// fastest slip rate.
static bool make(const FrictionSource *source, FrictionLaw *law, const char **key, Error *err)
{
    (void)key, (void)err;
    double weakens = law->evolution_effect - law->direct_effect;
    double fast = log(fmax(source->end / law->reference_velocity, 1));
    law->creeps = law->strengthens = true;
    law->critical_velocity = law->reference_velocity;
    law->mu_static = law->mu_reference + fmax(law->evolution_effect * law->start[0], 0);
    law->mu_kinetic = fmax(law->mu_reference - fmax(weakens, 0) * fast, 0);
    return true;
}

// mu = a asinh(v/v_s), v_s = 2 V_0 exp(-(f_0 + b psi)/a).
static void find_mu(const FrictionLaw *law, double speed, double pressure, const double *state,
                    FrictionRates *rates)
{
    (void)pressure;
    double exponent = (law->mu_reference + law->evolution_effect * *state) / law->direct_effect;
    double scale = 2 * law->reference_velocity *
                   exp(-fmin(fmax(exponent, -EXPONENT_MAX), EXPONENT_MAX));
    double root = hypot(speed, scale);
    rates->mu = law->direct_effect * asinh(speed / scale);
    rates->mu_speed = law->direct_effect / root;
    rates->mu_state[0] = law->evolution_effect * (speed / root);
}

static void find_rate(const FrictionLaw *law, double speed, double pressure, const double *state,
                      FrictionRates *rates)
{
    (void)pressure;
    double slips = 1 / law->slip_distance;
    if (law->slip_law) {
        double logarithm = *state + log(fmax(speed, LEAST_SPEED) / law->reference_velocity);
        rates->rate[0] = -speed * slips * logarithm;   // logarithm: ln(v theta/D_c)
        rates->rate_speed[0] = -slips * (logarithm + 1);
        rates->rate_state[0][0] = -speed * slips;
    } else {
        double heals = law->reference_velocity * slips * exp(fmin(-*state, EXPONENT_MAX));
        rates->rate[0] = heals - speed * slips;
        rates->rate_speed[0] = -slips;
        rates->rate_state[0][0] = -heals;
    }
}

static double rested(const FrictionLaw *law, double rest)
{
    return log(law->reference_velocity * rest / law->slip_distance);
}

static double steady(const FrictionLaw *law, double speed)
{
    return log(law->reference_velocity / speed);
}

static double shown(const FrictionLaw *law, double state)
{
    return law->slip_distance / law->reference_velocity * exp(state);
}

// Friction that ages, with beta = b/f_0 and theta_0 = D_c/V_0: exp(psi) is theta/theta_0.
static double area(const FrictionLaw *law, const double *state)
{
    double grown = *state > 0 ? *state + log1p(exp(-*state)) : log1p(exp(*state));
    return 1 + law->evolution_effect / law->mu_reference * grown;
}

const FrictionOperations friction_rate_state = {
    .must = "slip_distance direct_effect evolution_effect mu_reference reference_velocity",
    .may = "evolution rest",
    .has_drop = true,
    .make = make,
    .mu = find_mu,
    .rate = find_rate,
    .rested = rested,
    .steady = steady,
    .area = area,
    .shown = shown};
