// SPDX-License-Identifier: GPL-2.0-or-later
#include "friction/friction_state.h"

#include <string.h>

bool friction_remembers(const FrictionLaw *law, int32_t count)
{
    for (int32_t i = 0; law->each && i < count; i++)
        if (law->each[i].remembers) return true;
    return law->remembers;
}

int32_t friction_states(const FrictionLaw *law, int32_t count)
{
    int32_t most = law->remembers ? law->own.memory.states : 0;
    for (int32_t i = 0; law->each && i < count; i++) {
        bool more = law->each[i].remembers && law->each[i].own.memory.states > most;
        if (more) most = law->each[i].own.memory.states;
    }
    return most;
}

void friction_set_stage(FrictionLaw *law, const double *from, double reach)
{
    if (!law->remembers) return;
    FrictionMemory *memory = &law->own.memory;
    memcpy(memory->from, from, (size_t)memory->states * sizeof(double));
    memory->reach = reach;
    law->mu_static = memory_coefficient(memory, 0, NULL);
}

double friction_set_pressure(FrictionLaw *law, double pressure, double speed)
{
    if (!friction_feels_pressure(law)) return 0;
    FrictionMemory *memory = &law->own.memory;
    double before = memory_coefficient(memory, speed, NULL);
    memory->pressure = pressure;
    law->mu_static = memory_coefficient(memory, 0, NULL);
    return memory_coefficient(memory, speed, NULL) - before;
}

void friction_state(const FrictionLaw *law, double speed, double *state)
{
    if (law->remembers) memory_state(&law->own.memory, speed, state);
}

void friction_rates(const FrictionLaw *law, double speed, const double *state, FrictionRates *rates)
{
    if (law->remembers) {
        memory_rates(&law->own.memory, speed, state, rates);
        return;
    }
    rates->states = 0;
    rates->mu = friction_coefficient(law, speed);
    rates->mu_speed = friction_slope(law, speed);
    rates->mu_pressure = 0;
}

void friction_rates_pressed(const FrictionLaw *law, double pressure, double speed,
                            const double *state, FrictionRates *rates)
{
    FrictionLaw other;
    bool differs = friction_feels_pressure(law) && law->own.memory.pressure != pressure;
    if (differs) {
        other = *law;
        other.own.memory.pressure = pressure;
    }
    friction_rates(differs ? &other : law, speed, state, rates);
}

double friction_direct_slope(const FrictionLaw *law, double speed)
{
    double state[STATES_MAX];
    FrictionRates rates;
    friction_state(law, speed, state);
    friction_rates(law, speed, state, &rates);
    return rates.mu_speed;
}

void friction_follow(const FrictionLaw *law, int32_t count, const double *velocity,
                     const double *step, double *next)
{
    memory_follow(&law->own.memory, count, velocity, step, next);
}

void friction_start_state(const FrictionLaw *law, double *state)
{
    if (!law->remembers) return;
    memcpy(state, law->own.memory.start, (size_t)law->own.memory.states * sizeof(double));
}

double friction_shown_state(const FrictionLaw *law, int32_t k, double state)
{
    bool has = law->remembers && k < law->own.memory.states;
    return has ? memory_shown(&law->own.memory, state) : 0;
}
