// SPDX-License-Identifier: GPL-2.0-or-later
// A state keeps its products with M and K (momentum, elastic force) beside u and v.
#include "stepping/state.h"

#include "algebra/dense.h"
#include "base/memory.h"
#include "contact/slip.h"

#include <math.h>
#include <string.h>

// All zero but the statuses: every contact node sticks. On failure state_destroy frees what was
// made.
bool state_create(const BulkOperator *system, const Interface *interface, State *state, Error *err)
{
    *state = (State){.dof_count = system->dof_count,
                     .interface_count = interface->count,
                     .contact_count = interface->contact_count,
                     .rod_count = interface->rod_count,
                     .branch_count = bulk_operator_spectrum(system)->count};
    int64_t stretches = (int64_t)state->branch_count * state->dof_count;
    state->stretch = NEW_ARRAY(double, stretches, err);
    state->pull = NEW_ARRAY(double, stretches, err);
    state->displacement = NEW_ARRAY(double, state->dof_count, err);
    state->velocity = NEW_ARRAY(double, state->dof_count, err);
    state->elastic_force = NEW_ARRAY(double, state->dof_count, err);
    state->momentum = NEW_ARRAY(double, state->dof_count, err);
    state->inertia = NEW_ARRAY(double, state->dof_count, err);
    state->slip_rate = NEW_ARRAY(double, state->interface_count, err);
    state->reaction = NEW_ARRAY(double, state->interface_count, err);
    state->theta = NEW_ARRAY(double, (int64_t)state->contact_count *STATES_MAX, err);
    state->status = NEW_ARRAY(uint8_t, state->contact_count, err);
    state->rod_touches = NEW_ARRAY(uint8_t, state->rod_count, err);
    if (!error_is_clean(err)) return false;
    memset(state->status, CONTACT_STICK, (size_t)state->contact_count);
    return true;
}

void state_destroy(State *state)
{
    memory_free_all(state->displacement, state->velocity, state->elastic_force, state->momentum,
                    state->inertia, state->slip_rate, state->reaction, state->theta, state->status,
                    state->rod_touches, state->stretch, state->pull);
    *state = (State){0};
}

// Both are of the same system and interface; nothing is allocated.
void state_copy(const State *from, State *to)
{
    size_t bulk_bytes = (size_t)from->dof_count * sizeof(double);
    size_t branch_bytes = bulk_bytes * (size_t)from->branch_count;
    size_t interface_bytes = (size_t)from->interface_count * sizeof(double);
    to->time = from->time;
    to->rod_way = from->rod_way;
    memcpy(to->displacement, from->displacement, bulk_bytes);
    memcpy(to->velocity, from->velocity, bulk_bytes);
    memcpy(to->elastic_force, from->elastic_force, bulk_bytes);
    memcpy(to->momentum, from->momentum, bulk_bytes);
    memcpy(to->inertia, from->inertia, bulk_bytes);
    memcpy(to->slip_rate, from->slip_rate, interface_bytes);
    memcpy(to->reaction, from->reaction, interface_bytes);
    memcpy(to->theta, from->theta, (size_t)from->contact_count * STATES_MAX * sizeof(double));
    memcpy(to->stretch, from->stretch, branch_bytes);
    memcpy(to->pull, from->pull, branch_bytes);
    memcpy(to->status, from->status, (size_t)from->contact_count);
    memcpy(to->rod_touches, from->rod_touches, (size_t)from->rod_count);
}

double state_branch_energy(const State *state, int32_t k)
{
    int64_t at = (int64_t)k * state->dof_count;
    return 0.5 * dense_dot(state->stretch + at, state->pull + at, state->dof_count);
}

double state_elastic_energy(const State *state)
{
    double energy = 0.5 * dense_dot(state->displacement, state->elastic_force, state->dof_count);
    for (int32_t k = 0; k < state->branch_count; k++) energy += state_branch_energy(state, k);
    return energy;
}

void state_friction(const State *state, const Interface *interface, const FrictionNode *node,
                    int32_t i, FrictionRates *rates)
{
    double speed = slip_size(interface, i, state->slip_rate);
    const double *theta = state->theta + (int64_t)i * STATES_MAX;
    if (!node->law->feels_pressure) {
        friction_rates(node, speed, theta, rates);
        return;
    }
    double pressing = fmax(state->reaction[interface_normal(interface, i)], 0);
    friction_rates_pressed(node, pressing / interface->weight[i], speed, theta, rates);
}

void state_archive(State *state, Archive *archive)
{
    archive_section(archive, "state");
    archive_numbers_of(archive, &state->time, &state->rod_way);
    archive_numbers(archive, state->displacement, state->dof_count);
    archive_numbers(archive, state->velocity, state->dof_count);
    archive_numbers(archive, state->elastic_force, state->dof_count);
    archive_numbers(archive, state->momentum, state->dof_count);
    archive_numbers(archive, state->inertia, state->dof_count);
    archive_numbers(archive, state->slip_rate, state->interface_count);
    archive_numbers(archive, state->reaction, state->interface_count);
    archive_numbers(archive, state->theta, (int64_t)state->contact_count * STATES_MAX);
    int64_t stretches = (int64_t)state->branch_count * state->dof_count;
    archive_numbers(archive, state->stretch, stretches);
    archive_numbers(archive, state->pull, stretches);
    archive_octets(archive, state->status, state->contact_count);
    archive_octets(archive, state->rod_touches, state->rod_count);
}

// --- the load while the rod moves ---------------------------------------------------------------

double load_factor(const LoadCourse *course, double time)
{
    if (course == NULL) return 1;
    double x = course->by_way ? rod_displacement(course->rod, time) : time;
    return schedule_factor(&course->schedule, x);
}

double load_next(const LoadCourse *course, double time)
{
    if (course == NULL) return INFINITY;
    if (!course->by_way) return schedule_next(&course->schedule, time);
    double next = schedule_next(&course->schedule, rod_displacement(course->rod, time));
    return isfinite(next) ? rod_arrival(course->rod, next) : INFINITY;
}
