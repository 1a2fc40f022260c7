// SPDX-License-Identifier: GPL-2.0-or-later
#include "stepping/friction_states.h"

#include "base/memory.h"
#include "contact/friction_state.h"
#include "contact/slip.h"

#include <math.h>

bool friction_states_create(const Block *block, FrictionStates *states, Error *err)
{
    int64_t count = block->interface->contact_count;
    *states = (FrictionStates){.interface = block->interface};
    if (!friction_remembers(block->law, block->interface->contact_count)) return true;
    states->laws = block->stage_laws;
    for (int32_t i = 0; i < count; i++) {
        double state = friction_start_state(&states->laws[i]);
        FrictionRates rates = friction_rates(&states->laws[i], 0, fmax(state, 1));
        states->act = states->act || rates.mu_state > 0 || friction_creeps(&states->laws[i]);
    }
    states->rate = NEW_ARRAY(double, (TABLEAU_STAGES_MAX + 1) * count, err);
    return error_is_clean(err);
}

void friction_states_destroy(FrictionStates *states)
{
    memory_free(states->rate);
    *states = (FrictionStates){0};
}

void friction_states_reset(FrictionStates *states, State *state)
{
    for (int32_t i = 0; states->laws && i < states->interface->contact_count; i++) {
        state->theta[i] = friction_start_state(&states->laws[i]);
        friction_set_stage(&states->laws[i], state->theta[i], 0);
    }
}

static double *rates_of(const FrictionStates *states, int32_t stage)
{
    return states->rate + (int64_t)(stage + 1) * states->interface->contact_count;
}

void friction_states_begin(FrictionStates *states, const State *from)
{
    if (!states->laws) return;
    double *rate = rates_of(states, -1);
    for (int32_t i = 0; i < states->interface->contact_count; i++) {
        double speed = slip_size(states->interface, i, from->slip_rate);
        rate[i] = friction_rates(&states->laws[i], speed, from->theta[i]).rate;
    }
}

void friction_states_start_stage(FrictionStates *states, const Tableau *tableau, double step,
                                 int32_t stage, const State *from)
{
    double reach = states->frozen ? 0 : tableau->gamma * step;
    for (int32_t i = 0; states->laws && i < states->interface->contact_count; i++) {
        double start = from->theta[i];
        for (int32_t j = 0; j < stage && !states->frozen; j++)
            start += step * tableau->a[stage][j] * rates_of(states, j)[i];
        friction_set_stage(&states->laws[i], start, reach);
    }
}

void friction_states_end_stage(FrictionStates *states, int32_t stage, const double *velocity,
                               double *theta)
{
    if (!states->laws) return;
    double *rate = rates_of(states, stage);
    for (int32_t i = 0; i < states->interface->contact_count; i++) {
        double speed = slip_size(states->interface, i, velocity);
        theta[i] = friction_state(&states->laws[i], speed);
        rate[i] = friction_rates(&states->laws[i], speed, theta[i]).rate;
    }
}

double friction_states_error(const FrictionStates *states, const Tableau *tableau, double step,
                             const State *to)
{
    double largest = 0;
    if (!states->laws || states->frozen) return 0;
    for (int32_t i = 0; i < states->interface->contact_count; i++) {
        double speed = slip_size(states->interface, i, to->slip_rate), error = 0;
        for (int32_t j = 0; j <= tableau->stages; j++)
            error += tableau->error[j] * rates_of(states, j - 1)[i];
        double gain = friction_rates(&states->laws[i], speed, to->theta[i]).mu_state;
        error = fabs(step * error * gain) * states->slip_per_mu;
        if (!isfinite(error)) return INFINITY;
        largest = fmax(largest, error);
    }
    return largest;
}

void friction_states_archive(FrictionStates *states, Archive *archive)
{
    archive_section(archive, "friction states");
    archive_flag(archive, &states->frozen);
    for (int32_t i = 0; states->laws && i < states->interface->contact_count; i++) {
        FrictionMemory *memory = &states->laws[i].own.memory;
        double from = memory->from, reach = memory->reach;
        archive_number(archive, &from);
        archive_number(archive, &reach);
        if (archive_reads(archive)) friction_set_stage(&states->laws[i], from, reach);
    }
}
