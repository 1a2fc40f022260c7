// SPDX-License-Identifier: GPL-2.0-or-later
#include "stepping/friction_states.h"

#include "base/memory.h"
#include "friction/friction.h"
#include "contact/slip.h"

#include <math.h>
#include <string.h>

// Some state changes mu: not where friction heals by nothing.
static bool acts(const FrictionNode *node)
{
    double state[STATES_MAX];
    FrictionRates rates;
    if (!node->law->remembers) return false;
    friction_start_state(node, state);
    for (int32_t k = 0; k < node->law->states; k++) state[k] = fmax(state[k], 1);
    friction_rates(node, 0, state, &rates);
    bool acts = node->law->creeps || friction_is_own(node->law);
    for (int32_t k = 0; k < rates.states; k++) acts = acts || rates.mu_state[k] > 0;
    return acts;
}

bool friction_states_create(const Block *block, FrictionStates *states, Error *err)
{
    int64_t count = block->interface->contact_count;
    *states = (FrictionStates){.interface = block->interface};
    if (!friction_remembers(block->friction, block->interface->contact_count)) return true;
    states->node = block->stage_friction;
    for (int32_t i = 0; i < count; i++) states->act = states->act || acts(&states->node[i]);
    states->rate = NEW_ARRAY(double, (SDIRK_STAGES + 1) * count * STATES_MAX, err);
    states->mu_state = NEW_ARRAY(double, count *STATES_MAX, err);
    return error_is_clean(err);
}

void friction_states_destroy(FrictionStates *states)
{
    memory_free_all(states->rate, states->mu_state);
    *states = (FrictionStates){0};
}

static double *state_of(const State *state, int32_t i)
{
    return state->theta + (int64_t)i * STATES_MAX;
}

void friction_states_reset(FrictionStates *states, State *state)
{
    for (int32_t i = 0; states->node && i < states->interface->contact_count; i++) {
        friction_start_state(&states->node[i], state_of(state, i));
        friction_set_stage(&states->node[i], state_of(state, i), 0);
    }
}

static double *rates_of(const FrictionStates *states, int32_t stage, int32_t i)
{
    return states->rate +
           ((int64_t)(stage + 1) * states->interface->contact_count + i) * STATES_MAX;
}

static void keep_rates(const FrictionStates *states, int32_t stage, const State *state)
{
    for (int32_t i = 0; i < states->interface->contact_count; i++) {
        FrictionRates rates;
        state_friction(state, states->interface, &states->node[i], i, &rates);
        size_t bytes = (size_t)rates.states * sizeof(double);
        memcpy(rates_of(states, stage, i), rates.rate, bytes);
        memcpy(states->mu_state + (int64_t)i * STATES_MAX, rates.mu_state, bytes);
    }
}

void friction_states_begin(FrictionStates *states, const State *from)
{
    if (states->node) keep_rates(states, -1, from);
}

void friction_states_start_stage(FrictionStates *states, double step, int32_t stage,
                                 const State *from)
{
    double reach = states->frozen ? 0 : SDIRK2.gamma * step, start[STATES_MAX];
    for (int32_t i = 0; states->node && i < states->interface->contact_count; i++) {
        memcpy(start, state_of(from, i), sizeof start);
        for (int32_t j = 0; j < stage && !states->frozen; j++)
            for (int32_t k = 0; k < STATES_MAX; k++)
                start[k] += step * SDIRK2.a[stage][j] * rates_of(states, j, i)[k];
        friction_set_stage(&states->node[i], start, reach);
    }
}

static const double PRESSED = 1e-11;   // of mu, 1

bool friction_states_press(FrictionStates *states, const double *velocity, const double *reaction)
{
    bool changed = false;
    for (int32_t i = 0; states->node && i < states->interface->contact_count; i++) {
        double pressing = fmax(reaction[interface_normal(states->interface, i)], 0);
        double change = friction_set_pressure(&states->node[i],
                                              pressing / states->interface->weight[i],
                                              slip_size(states->interface, i, velocity));
        changed = changed || !(fabs(change) <= PRESSED);
    }
    return changed;
}

void friction_states_end_stage(FrictionStates *states, int32_t stage, State *to)
{
    if (!states->node) return;
    for (int32_t i = 0; i < states->interface->contact_count; i++)
        friction_state(&states->node[i], slip_size(states->interface, i, to->slip_rate),
                       state_of(to, i));
    keep_rates(states, stage, to);
}

double friction_states_error(const FrictionStates *states, double step)
{
    double largest = 0;
    if (!states->node || states->frozen) return 0;
    for (int32_t i = 0; i < states->interface->contact_count; i++) {
        const double *mu_state = states->mu_state + (int64_t)i * STATES_MAX;
        for (int32_t k = 0; k < states->node[i].law->states; k++) {
            double error = 0;
            for (int32_t j = 0; j <= SDIRK_STAGES; j++)
                error += SDIRK2.error[j] * rates_of(states, j - 1, i)[k];
            error = fabs(step * error * mu_state[k]) * states->slip_per_mu;
            if (!isfinite(error)) return INFINITY;
            largest = fmax(largest, error);
        }
    }
    return largest;
}

bool friction_states_hold(const FrictionStates *states, const double *at, double *speed, double *mu)
{
    double state[STATES_MAX], sum = 0;
    for (int32_t i = 0; states->node && i < states->interface->contact_count; i++) {
        FrictionRates rates;
        *speed = slip_size(states->interface, i, at);
        friction_state(&states->node[i], *speed, state);
        friction_rates(&states->node[i], *speed, state, &rates);
        *mu = rates.mu;
        for (int32_t k = 0; k < rates.states; k++) sum += state[k] + rates.rate[k];
        if (!isfinite(sum + *mu) || *mu < 0) return false;
    }
    return true;
}

void friction_states_archive(FrictionStates *states, Archive *archive)
{
    archive_section(archive, "friction states");
    archive_flag(archive, &states->frozen);
    for (int32_t i = 0; states->node && i < states->interface->contact_count; i++) {
        FrictionNode *node = &states->node[i];
        double from[STATES_MAX], reach = node->reach;
        if (!node->law->remembers) continue;
        memcpy(from, node->from, sizeof from);
        archive_numbers(archive, from, node->law->states);
        archive_numbers_of(archive, &node->pressure, &reach);
        if (archive_reads(archive)) friction_set_stage(node, from, reach);
    }
}
