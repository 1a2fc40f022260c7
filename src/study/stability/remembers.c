// SPDX-License-Identifier: GPL-2.0-or-later
// Friction that remembers on the quasi-static path. The path's rod goes at a velocity of its own,
// so its friction is put on the path's clock (friction_paced): what they say there of mu and
// of the part of a way that is forgotten is what the scene's rod meets. States are looked at in the
// scene's time.
#include "study/stability/stability.h"

#include "base/memory.h"
#include "friction/friction_response.h"
#include "friction/friction_start.h"

#include <math.h>
#include <string.h>

bool stability_set_pace(StabilityPath *path, double velocity, Error *err)
{
    const Model *model = path->model;
    int32_t count = model->interface.contact_count;
    if (!friction_remembers(&model->friction, count)) return true;
    if (!path->options->at_end) path->pace = velocity / model->scene->rod.velocity;
    TRY((path->nodes = NEW_ARRAY(FrictionNode, count, err)));
    for (int32_t i = 0; i < count; i++)
        path->nodes[i] = friction_paced(friction_at(&model->friction, i), path->pace);
    path->friction = friction_of_nodes(path->nodes, count);
    path->scales.slip_velocity *= path->pace;
cleanup:
    return error_is_clean(err);
}

// Velocities of `state` on a clock that runs `pace` times as fast; what is remembered is the same.
static void change_clock(double pace, State *state)
{
    for (int32_t k = 0; k < state->interface_count; k++) state->slip_rate[k] *= pace;
    for (int32_t k = 0; k < state->dof_count; k++) {
        state->velocity[k] *= pace;
        state->momentum[k] *= pace;
    }
}

void stability_start_states(StabilityPath *path)
{
    if (path->nodes) change_clock(path->pace, &path->control.now);
}

void stability_look(StabilityPath *path)
{
    state_copy(&path->control.now, &path->last);
    if (path->nodes) change_clock(1 / path->pace, &path->last);
}

static FrictionRates steady_rates(const StabilityPath *path, int32_t i, double pressure,
                                  double *state)
{
    FrictionNode node = *friction_at(&path->model->friction, i);
    if (node.law->remembers) node.pressure = pressure;
    return friction_steady_rates(&node, path->model->scales.slip_velocity, state);
}

void stability_let_slip(const StabilityPath *path, State *trial, int32_t i)
{
    const Interface *interface = &path->model->interface;
    int32_t t = interface_tangent(interface, i);
    double pressing = trial->reaction[interface_normal(interface, i)];
    trial->status[i] = CONTACT_SLIP_FORWARD;
    for (int32_t c = 0; c < interface->dim - 1; c++) trial->slip_rate[t + c] = 0;
    if (!path->nodes) return;
    steady_rates(path, i, pressing / interface->weight[i], &trial->theta[i * STATES_MAX]);
    trial->slip_rate[t] = path->model->scales.slip_velocity;
}

double stability_critical_spring(const StabilityPath *path, int32_t i, double pressure)
{
    double state[STATES_MAX];
    FrictionRates rates = steady_rates(path, i, pressure, state);
    return rates.states > 0 ? pressure * friction_critical_stiffness(&rates) : NAN;
}
