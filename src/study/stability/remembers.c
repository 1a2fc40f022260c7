// SPDX-License-Identifier: GPL-2.0-or-later
// Friction that remembers on the quasi-static path. The path's rod goes at a velocity of its own,
// so its laws are put on the path's clock (friction/friction_pace): what they say there of mu and
// of the part of a way that is forgotten is what the scene's rod meets. States are looked at in the
// scene's time.
#include "study/stability/stability.h"

#include "base/memory.h"
#include "friction/friction_pace.h"
#include "friction/friction_state.h"

#include <math.h>

bool stability_set_pace(StabilityPath *path, double velocity, Error *err)
{
    const Model *model = path->model;
    int32_t count = model->interface.contact_count;
    if (!friction_remembers(&model->law, count)) return true;
    if (!path->options->at_end) path->pace = velocity / model->scene->rod.velocity;
    TRY((path->laws = NEW_ARRAY(FrictionLaw, count, err)));
    for (int32_t i = 0; i < count; i++)
        path->laws[i] = friction_paced(friction_at(&model->law, i), path->pace);
    path->law = friction_spread(path->laws, count);
    path->scales.slip_velocity *= path->pace;
cleanup:
    return error_is_clean(err);
}

// Velocities and states of `state` on a clock that runs `pace` times as fast.
static void change_clock(const StabilityPath *path, double pace, State *state)
{
    for (int32_t i = 0; i < state->contact_count; i++)
        state->theta[i * STATES_MAX] =
            friction_paced_state(&path->laws[i], state->theta[i * STATES_MAX], pace);
    for (int32_t k = 0; k < state->interface_count; k++) state->slip_rate[k] *= pace;
    for (int32_t k = 0; k < state->dof_count; k++) {
        state->velocity[k] *= pace;
        state->momentum[k] *= pace;
    }
}

void stability_start_states(StabilityPath *path)
{
    if (path->laws) change_clock(path, path->pace, &path->control.now);
}

void stability_look(StabilityPath *path)
{
    state_copy(&path->control.now, &path->last);
    if (path->laws) change_clock(path, 1 / path->pace, &path->last);
}

// mu and g of node i at steady slip at V: the state in which a stage of any length ends.
static FrictionRates steady_rates(const StabilityPath *path, int32_t i, double *state)
{
    static const double LONG = 1e9;   // slip of such a stage, of the law's own distance
    FrictionLaw law = *friction_at(&path->model->law, i);
    double speed = path->model->scales.slip_velocity;
    double distance = law.remembers ? law.own.memory.slip_distance : 0;
    FrictionRates rates;
    friction_start_state(&law, state);
    friction_set_stage(&law, state, LONG * distance / speed);
    friction_state(&law, speed, state);
    friction_rates(&law, speed, state, &rates);
    return rates;
}

double stability_forgets(const StabilityPath *path, int32_t i)
{
    double state[STATES_MAX] = {0};
    FrictionRates rates = steady_rates(path, i, state);
    return rates.states > 0 && rates.rate_state[0][0] < 0 ? -rates.rate_state[0][0] : INFINITY;
}

void stability_let_slip(const StabilityPath *path, State *trial, int32_t i)
{
    const Interface *interface = &path->model->interface;
    int32_t t = interface_tangent(interface, i);
    trial->status[i] = CONTACT_SLIP_FORWARD;
    for (int32_t c = 0; c < interface->dim - 1; c++) trial->slip_rate[t + c] = 0;
    if (!path->laws) return;
    steady_rates(path, i, &trial->theta[i * STATES_MAX]);
    trial->slip_rate[t] = path->model->scales.slip_velocity;
}

// With w = -mu_v r_n, m = -mu_theta g_v r_n and f = -g_theta slip on a spring k obeys
// -w s^2 + (k - w f - m) s + k f = 0: stable for w < 0 where k > m + w f, and for w = 0 where k >
// m.
double stability_critical_spring(const StabilityPath *path, int32_t i, double pressing)
{
    double state[STATES_MAX] = {0};
    FrictionRates rates = steady_rates(path, i, state);
    if (!path->laws || rates.mu_speed < 0) return NAN;
    double memory = -rates.mu_state[0] * rates.rate_speed[0];
    return fmax(pressing * (memory + rates.mu_speed * rates.rate_state[0][0]), 0);
}
