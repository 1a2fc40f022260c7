// SPDX-License-Identifier: GPL-2.0-or-later
#include "friction/friction_state.h"

#include "algebra/dense.h"

#include <math.h>
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
    if (!law->remembers || !law->own.memory.feels_pressure) return 0;
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

double friction_weakens_at(const FrictionRates *rates, double reach)
{
    return -memory_feedback(rates, reach);
}

// With G = D + O, D the diagonal, and R = (s - D)^-1, |R_kk| <= P_kk = reach/sqrt(1 + (reach
// G_kk)^2) at such s where G_kk <= 0: (s - G)^-1 = R + R O R + R O R O R + ... The first term is a
// sum over the states, of which only those that weaken count, as Re R_kk >= 0 (a state that grows
// by itself, G_kk > 0, has 1/reach - G_kk in the place of 1/P_kk, and counts either way); all
// others together are no more, entry by entry, than (P^-1 - |O|)^-1 |g_v| - P |g_v|, where these
// sums converge: where (P^-1 - |O|)^-1 (1, ..., 1) is above 0 (Berman and Plemmons, Nonnegative
// Matrices in the Mathematical Sciences, 1994, ch. 6).
double friction_weakens_most(const FrictionRates *rates, double reach)
{
    double matrix[STATES_MAX * STATES_MAX], coupled[STATES_MAX], ones[STATES_MAX];
    double bound[STATES_MAX], most = 0;
    int32_t pivots[STATES_MAX], n = rates->states;
    bool couples = false;
    for (int32_t k = 0; k < n; k++) {
        double own = reach * rates->rate_state[k][k];
        double weakens = -rates->mu_state[k] * rates->rate_speed[k];
        bound[k] = reach / (own <= 0 ? hypot(1, own) : 1 - own);
        if (!(bound[k] >= 0)) return INFINITY;
        most += (own <= 0 ? fmax(weakens, 0) : fabs(weakens)) * bound[k];
        coupled[k] = fabs(rates->rate_speed[k]);
        ones[k] = 1;
        for (int32_t j = 0; j < n; j++) {
            couples = couples || (j != k && rates->rate_state[k][j] != 0);
            matrix[j * n + k] = j == k ? 1 / bound[k] : -fabs(rates->rate_state[k][j]);
        }
    }
    if (!couples || reach == 0) return most;
    if (!dense_lu(matrix, n, pivots)) return INFINITY;
    dense_lu_solve(matrix, n, pivots, coupled);
    dense_lu_solve(matrix, n, pivots, ones);
    for (int32_t k = 0; k < n; k++) {
        if (!(ones[k] > 0)) return INFINITY;
        most += fabs(rates->mu_state[k]) *
                fmax(coupled[k] - bound[k] * fabs(rates->rate_speed[k]), 0);
    }
    return most;
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
