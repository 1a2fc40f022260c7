// SPDX-License-Identifier: GPL-2.0-or-later
// Forces of nodes become stresses by the node's weight (contact/interface): p = r_n / w, tau =
// -r_t / w. Slip is counted from the first step, so that it is 0 when the rod starts.
#include "record/contact_arrays.h"

#include "base/memory.h"
#include "contact/slip.h"
#include "friction/friction.h"
#include "io/hdf5/result_tables.h"

#include <stdio.h>

static const double SLIGHT = 1e-6;   // of the pressure: what a formula may be below 0

// friction must outlive the arrays.
bool contact_arrays_create(const Interface *interface, const Friction *friction,
                           ContactArrays *arrays, Error *err)
{
    int32_t count = interface->contact_count, tangents = slip_tangents(interface);
    *arrays = (ContactArrays){.friction = friction, .count = count, .tangents = tangents};
    arrays->slip_rate = NEW_ARRAY(double, count *tangents, err);
    arrays->slip = NEW_ARRAY(double, count *tangents, err);
    arrays->pressure = NEW_ARRAY(double, count, err);
    arrays->shear = NEW_ARRAY(double, count *tangents, err);
    arrays->gap = NEW_ARRAY(double, count, err);
    arrays->status = NEW_ARRAY(uint8_t, count, err);
    arrays->states = friction_states(friction, count);
    if (arrays->states > 0) arrays->state = NEW_ARRAY(double, (int64_t)count * arrays->states, err);
    bool has_area = false;
    for (int32_t i = 0; i < count; i++)
        has_area = has_area || friction_has_area(friction_at(friction, i));
    if (has_area) arrays->area = NEW_ARRAY(double, count, err);
    arrays->origin = NEW_ARRAY(double, count *tangents, err);
    return error_is_clean(err);
}

void contact_arrays_destroy(ContactArrays *arrays)
{
    memory_free_all(arrays->slip_rate, arrays->slip, arrays->pressure, arrays->shear, arrays->gap,
                    arrays->status, arrays->state, arrays->area, arrays->origin);
    *arrays = (ContactArrays){0};
}

// Refuses a negative coefficient at node i. Before the run, formulas and plug-ins are checked in
// steady slip alone, at many speeds, and may fall below 0 where the run leads. Friction would then
// drive the block.
static bool check_coefficient(const Observation *seen, const Friction *friction, int32_t i,
                              Error *err)
{
    const FrictionNode *node = friction_at(friction, i);
    const Interface *interface = seen->interface;
    if (!friction_is_own(node->law)) return true;
    const double *theta = seen->state->theta + (int64_t)i * STATES_MAX;
    double speed = slip_size(interface, i, seen->state->slip_rate);
    char states[25 * STATES_MAX] = "";
    FrictionRates rates;
    friction_rates(node, speed, theta, &rates);
    if (rates.mu >= -SLIGHT) return true;
    for (int32_t k = 0, used = 0; k < rates.states; k++)
        used += snprintf(states + used, sizeof states - (size_t)used, "%s%g", k ? ", " : ", state ",
                         theta[k]);
    return FAULT(
        err, ERROR_COMPUTE,
        "at U = %.6g, t = %.9g friction has come to a coefficient of %g, at contact node %d, x = "
        "%g: velocity %g, pressure %g%s. It must not be negative wherever a run leads: max(0, "
        "...) in the formula keeps it from that",
        seen->U, seen->t, rates.mu, i, interface->x[i], speed,
        seen->state->reaction[interface_normal(interface, i)] / interface->weight[i], states);
}

bool seen_check_coefficients(const Observation *seen, const Friction *friction, Error *err)
{
    for (int32_t i = 0; i < seen->interface->contact_count; i++)
        if (!check_coefficient(seen, friction, i, err)) return false;
    return true;
}

double seen_contact_area(const Observation *seen, const Friction *friction, int32_t i)
{
    const State *state = seen->state;
    if (state->status[i] == CONTACT_OPEN) return 0;
    return friction_contact_area(friction_at(friction, i),
                                 slip_size(seen->interface, i, state->slip_rate),
                                 state->theta + (int64_t)i * STATES_MAX);
}

bool contact_arrays_record(void *self, const Observation *seen, Error *err)
{
    ContactArrays *arrays = self;
    const State *state = seen->state;
    if (!seen_check_coefficients(seen, arrays->friction, err)) return false;
    for (int32_t i = 0; i < arrays->count; i++) {
        int32_t n = interface_normal(seen->interface, i);
        for (int32_t c = 0; c < arrays->tangents; c++) {
            int32_t t = interface_unknown(seen->interface, i, c), k = arrays->tangents * i + c;
            double displacement = state->displacement[seen->system->interface_dofs[t]];
            if (!arrays->started) arrays->origin[k] = displacement;
            arrays->slip_rate[k] = state->slip_rate[t];
            arrays->slip[k] = displacement - arrays->origin[k];
            arrays->shear[k] = -state->reaction[t] / seen->interface->weight[i];
        }
        for (int32_t k = 0; k < arrays->states; k++)
            arrays->state[i * arrays->states + k] = friction_shown_state(
                friction_at(arrays->friction, i), k, state->theta[i * STATES_MAX + k]);
        arrays->pressure[i] = state->reaction[n] / seen->interface->weight[i];
        double moved = state->displacement[seen->system->interface_dofs[n]];
        arrays->gap[i] =
            state->status[i] == CONTACT_OPEN ? moved + interface_gap(seen->interface, i) : 0;

        // The status is the history's (docs/results.md), not the contact solver's.
        uint8_t status = seen_status(seen, i);
        double speed = slip_size(seen->interface, i, state->slip_rate);
        if (status_slips(status))
            status = friction_weakens(friction_at(arrays->friction, i), speed) ? STATUS_WEAKENS
                                                                               : STATUS_SLIPS;
        arrays->status[i] = status;
    }
    for (int32_t i = 0; arrays->area && i < arrays->count; i++)
        arrays->area[i] = seen_contact_area(seen, arrays->friction, i);
    arrays->started = true;
    return true;
}

void contact_arrays_archive(ContactArrays *arrays, Archive *archive)
{
    archive_section(archive, "contact arrays");
    archive_flag(archive, &arrays->started);
    archive_numbers(archive, arrays->origin, (int64_t)arrays->count * arrays->tangents);
}
