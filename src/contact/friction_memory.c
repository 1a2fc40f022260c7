// SPDX-License-Identifier: GPL-2.0-or-later
// The header has the laws. Each has its rates (mu, g and their derivatives) and the closed form of
// the stage's state; all else is the same for all. tests/unit/contact/test_friction_memory.c
// compares derivatives with differences and states with their equation.
#include "contact/friction_memory.h"

#include <math.h>

static const double EXPONENT_MAX = 690;   // exp of it is finite
static const double LEAST_SPEED = 1e-300;   // ln of it is finite: at rest the slip law keeps its
    // state

// Where a step that is too long would leave theta below 0 the law is that of a fresh contact; such
// a step's error is large, and it is taken shorter (stepping/sdirk).
static FrictionRates ageing_rates(const FrictionMemory *memory, double speed, double state)
{
    double drop = memory->mu_static - memory->mu_kinetic, base = memory->mu_kinetic, slope = 0;
    bool weakens = speed<memory->critical_velocity, aged = state> 0;
    if (weakens) {
        base = memory->mu_static - drop * speed / memory->critical_velocity;
        slope = -drop / memory->critical_velocity;
    }
    double strength = aged ? 1 + memory->healing * log1p(state / memory->healing_time) : 1;
    double gain = aged ? memory->healing / (memory->healing_time + state) : 0;
    return (FrictionRates){.mu = base * strength,
                           .mu_speed = slope * strength,
                           .mu_state = base * gain,
                           .rate = 1 - speed * state / memory->slip_distance,
                           .rate_speed = -state / memory->slip_distance,
                           .rate_state = -speed / memory->slip_distance};
}

static FrictionRates weakening_rates(const FrictionMemory *memory, double speed, double state)
{
    double drop = memory->mu_static - memory->mu_kinetic;
    double heals = 1 / memory->healing_time, slips = 1 / memory->slip_distance;
    return (FrictionRates){.mu = memory->mu_kinetic + drop * fmax(state, 0),
                           .mu_state = state > 0 ? drop : 0,
                           .rate = (1 - state) * heals - speed * state * slips,
                           .rate_speed = -state * slips,
                           .rate_state = -heals - speed * slips};
}

// v_s = 2 V_0 exp(-(f_0 + b psi)/a): mu = a asinh(v/v_s).
static double creep_scale(const FrictionMemory *memory, double state)
{
    double exponent = (memory->reference + memory->healing * state) / memory->direct;
    return 2 * memory->reference_velocity * exp(-fmin(fmax(exponent, -EXPONENT_MAX), EXPONENT_MAX));
}

static FrictionRates rate_state_rates(const FrictionMemory *memory, double speed, double state)
{
    double scale = creep_scale(memory, state);
    double root = hypot(speed, scale), slips = 1 / memory->slip_distance;
    FrictionRates rates = {.mu = memory->direct * asinh(speed / scale),
                           .mu_speed = memory->direct / root,
                           .mu_state = memory->healing * (speed / root)};
    if (memory->slip_law) {
        double off =
            state + log(fmax(speed, LEAST_SPEED) / memory->reference_velocity);   // ln(v theta/D_c)
        rates.rate = -speed * slips * off;
        rates.rate_speed = -slips * (off + 1);
        rates.rate_state = -speed * slips;
    } else {
        double heals = memory->reference_velocity * slips * exp(fmin(-state, EXPONENT_MAX));
        rates.rate = heals - speed * slips;
        rates.rate_speed = -slips;
        rates.rate_state = -heals;
    }
    return rates;
}

FrictionRates memory_rates(const FrictionMemory *memory, double speed, double state)
{
    switch (memory->kind) {
    case MEMORY_AGEING:
        return ageing_rates(memory, speed, state);
    case MEMORY_SLIP_WEAKENING:
        return weakening_rates(memory, speed, state);
    case MEMORY_RATE_STATE:
        break;
    }
    return rate_state_rates(memory, speed, state);
}

// y > 0 of y + ln y = x (Wright's omega). Newton's method from below, where it cannot overshoot.
static double wright_omega(double x)
{
    enum { STEPS = 30 };
    if (x < -EXPONENT_MAX) return 0;
    double y = x > 1 ? x - log(x) : exp(x) / (1 + exp(x));
    for (int k = 0; k < STEPS; k++) {
        double next = y * (1 + x - log(y)) / (1 + y);
        if (!(next > y)) break;
        y = next;
    }
    return y;
}

// psi = q + y, y = (reach V_0/D_c) exp(-psi), q = from - reach v/D_c: by the one or the other, so
// that few digits cancel.
static double aged_state(const FrictionMemory *memory, double speed)
{
    double way = memory->reach / memory->slip_distance, q = memory->from - way * speed;
    double heals = log(way * memory->reference_velocity), y = wright_omega(heals - q);
    return y > 1 ? heals - log(y) : q + y;
}

double memory_state(const FrictionMemory *memory, double speed)
{
    double reach = memory->reach, from = memory->from, slips = reach / memory->slip_distance;
    if (reach == 0) return from;
    switch (memory->kind) {
    case MEMORY_AGEING:
        return (from + reach) / (1 + slips * speed);
    case MEMORY_SLIP_WEAKENING:
        return (from + reach / memory->healing_time) /
               (1 + reach / memory->healing_time + slips * speed);
    case MEMORY_RATE_STATE:
        break;
    }
    if (!memory->slip_law) return aged_state(memory, speed);
    double steady = log(fmax(speed, LEAST_SPEED) / memory->reference_velocity);
    return (from - slips * speed * steady) / (1 + slips * speed);
}

double memory_coefficient(const FrictionMemory *memory, double speed, double *slope)
{
    FrictionRates rates = memory_rates(memory, speed, memory_state(memory, speed));
    double reach = memory->reach;
    *slope = rates.mu_speed +
             rates.mu_state * reach * rates.rate_speed / (1 - reach * rates.rate_state);
    return rates.mu;
}

double memory_follow(const FrictionMemory *memory, double velocity, double step)
{
    double scale = creep_scale(memory, memory_state(memory, fabs(velocity)));
    double way = asinh(velocity / scale) + step / hypot(velocity, scale);
    return scale * sinh(fmin(fmax(way, -EXPONENT_MAX), EXPONENT_MAX));
}

double memory_rested(const FrictionMemory *memory, double rest)
{
    switch (memory->kind) {
    case MEMORY_AGEING:
        return rest;
    case MEMORY_SLIP_WEAKENING:
        return -expm1(-rest / memory->healing_time);
    case MEMORY_RATE_STATE:
        break;
    }
    return log(memory->reference_velocity * rest / memory->slip_distance);
}

double memory_steady(const FrictionMemory *memory, double speed)
{
    switch (memory->kind) {
    case MEMORY_AGEING:
        return memory->slip_distance / speed;
    case MEMORY_SLIP_WEAKENING:
        return 1 / (1 + speed * memory->healing_time / memory->slip_distance);
    case MEMORY_RATE_STATE:
        break;
    }
    return log(memory->reference_velocity / speed);
}

double memory_shown(const FrictionMemory *memory, double state)
{
    if (memory->kind != MEMORY_RATE_STATE) return state;
    return memory->slip_distance / memory->reference_velocity * exp(state);
}

double memory_spent_speed(const FrictionMemory *memory)
{
    static const double MANY = 20;   // of D_c that are slipped in the stage
    double speed = memory->kind == MEMORY_AGEING ? memory->critical_velocity : 0;
    return memory->reach > 0 ? speed + MANY * memory->slip_distance / memory->reach : speed;
}
