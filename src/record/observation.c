// SPDX-License-Identifier: GPL-2.0-or-later
#include "record/observation.h"

#include "algebra/dense.h"
#include "contact/slip.h"
#include "friction/friction.h"

#include <assert.h>
#include <float.h>
#include <math.h>
#include <string.h>

// Velocities of contact are judged against the rod's, and this many times what rounding leaves of a
// displacement divided by the step: less cannot be told from nothing.
static const double ROUNDINGS_LIMIT = 1e6;

// Where friction is 0 at rest every node slips at all times. A node that is slower than this part
// of the rod's velocity hardly moves while the rod drives the block by its own slip.
static const double CREEP = 0.1;

Observation observe(const StepControl *control, const ObservationScales *scales)
{
    const Sdirk *scheme = &control->scheme;
    const Interface *interface = scheme->interface;
    const State *state = &control->now;
    Observation seen = {.state = state,
                        .interface = interface,
                        .system = scheme->system,
                        .t = state->time,
                        .U = rod_displacement(scheme->rod, state->time),
                        .rod_way = state->rod_way,
                        .step_size = control->counters.accepted > 0 ? control->last_step : 0,
                        .rod_force = rod_force(interface, state->reaction),
                        .trailing = scales->trailing,
                        .certified = control->certified,
                        .grows = control->grows,
                        .friction = scheme->friction,
                        .creep = CREEP * scales->slip_velocity};

    // The front: x of the last node of the run of nodes from the trailing edge that do not stick.
    seen.front = interface_line_x(interface, 0);
    for (int32_t k = 0; k < interface_line_count(interface); k++) {
        int32_t i = interface_line_node(interface, k);
        if (seen_status(&seen, i) == CONTACT_STICK) break;
        seen.front_slips = seen.front_slips || status_slips(seen_status(&seen, i));
        seen.front = interface->x[i];
    }

    // mu, and the extremes over the contact.
    if (scheme->rod->stiffness == 0) seen.rod_way = seen.U;
    double load = scales->load * load_factor(scheme->course, state->time);
    seen.mu = seen.rod_force / load;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        int32_t n = interface_normal(interface, i);
        seen.normal_force += state->reaction[n];
        double height = state->displacement[seen.system->interface_dofs[n]];
        seen.penetration = fmax(seen.penetration, -height - interface_gap(interface, i));
        seen.max_slip_rate = fmax(seen.max_slip_rate, slip_size(interface, i, state->slip_rate));
    }

    // Moments about the origin, x F_z - z F_x, of everything but inertia; and of inertia.
    const BulkOperator *system = scheme->system;
    const double *rotation = system->rigid + (int64_t)interface->dim * system->dof_count;
    double moment = load_factor(scheme->course, state->time) *
                    dense_dot(rotation, system->load, system->dof_count);
    double inertia = dense_dot(rotation, state->inertia, system->dof_count);
    for (int32_t k = 0; k < interface->count; k++)
        moment += rotation[system->interface_dofs[k]] * state->reaction[k];
    seen.moment_error = fabs(moment - inertia) / (scales->load * scales->length);
    seen.moment_static_error = fabs(moment) / (scales->load * scales->length);

    // The ledger of energy.
    seen.energy_imbalance = energy_imbalance(&control->ledger);
    // A rod that hits a block at rest turns over more than the ledger holds as yet.
    double speed = scheme->rod->velocity;
    double turnover =
        fmax(energy_turnover(&control->ledger), 0.5 * scheme->system->mass_total * speed * speed);
    seen.energy_error = turnover > 0 ? fabs(seen.energy_imbalance) / turnover : 0;

    // Conditions of the contact at the end of the step.
    if (control->counters.accepted > 0) {
        double rounding = DBL_EPSILON * dense_max_abs(state->displacement, state->dof_count) /
                          scheme->reach;
        // The scheme still holds the bounds of the accepted step's last stage.
        ContactProblem problem = {.interface = interface,
                                  .friction = scheme->friction,
                                  .rod_kind = scheme->rod->kind,
                                  .rod_softness = scheme->rod->softness,
                                  .rod_lag = scheme->rod->lag,
                                  .rod_reach = scheme->reach,
                                  .bound = scheme->bound};
        ContactResidual residual = contact_residual(
            &problem, state->slip_rate, state->reaction, scales->load / interface->contact_count,
            fmax(scales->slip_velocity, ROUNDINGS_LIMIT * rounding));
        seen.contact_error = contact_residual_max(&residual);
        seen.equation_error = control->outcome.residual / scales->load;
    }
    return seen;
}

void pad_sums(const Observation *seen, PadSum *sums)
{
    const Interface *interface = seen->interface;
    const State *state = seen->state;
    memset(sums, 0, (size_t)interface->pad_count * sizeof *sums);
    for (int32_t i = 0; i < interface->contact_count; i++) {
        PadSum *sum = &sums[interface->pad[i]];
        sum->normal_force += state->reaction[interface_normal(interface, i)];
        sum->shear -= state->reaction[interface_tangent(interface, i)];
        if (interface->y) sum->shear_across -= state->reaction[interface_tangent(interface, i) + 1];
        if (!status_slips(seen_status(seen, i))) continue;
        sum->slipping += interface->weight[i];
        // Neighbours along the contact belong to the same pad where there is contact between them.
        int32_t pad = interface->pad[i], last = interface->contact_count - 1;
        double before = i > 0 && interface->pad[i - 1] == pad ? 0.5 : 0;
        double after = i < last && interface->pad[i + 1] == pad ? 0.5 : 0;
        sum->slipping_cells += before + after;
        sum->fastest = fmax(sum->fastest, slip_size(interface, i, state->slip_rate));
    }
}

PadSize pad_size(const Interface *interface, int32_t p)
{
    PadSize size = {.x_from = INFINITY, .x_to = -INFINITY, .breadth = 1};
    for (int32_t i = 0; i < interface->contact_count; i++) {
        double y = interface->y ? interface->y[i] : 0;
        if (interface->pad[i] != p) continue;
        size.x_from = fmin(size.x_from, interface->x[i]);
        size.x_to = fmax(size.x_to, interface->x[i]);
        size.y_from = size.nodes == 0 ? y : fmin(size.y_from, y);
        size.y_to = size.nodes == 0 ? y : fmax(size.y_to, y);
        size.weight += interface->weight[i];
        size.nodes++;
    }
    if (interface->y && size.x_to > size.x_from)
        size.breadth = size.weight / (size.x_to - size.x_from);
    return size;
}

void pad_sums_archive(PadSum *sums, int32_t count, Archive *archive)
{
    const int64_t numbers = sizeof *sums / sizeof(double);   // which is all that there is in one
    archive_numbers(archive, &sums->normal_force, numbers * count);
}

void recorders_add(Recorders *recorders, void *self,
                   bool (*record)(void *self, const Observation *seen, Error *err))
{
    assert(recorders->count < RECORDERS_MAX);
    recorders->list[recorders->count++] = (Recorder){.self = self, .record = record};
}

bool recorders_record(const Recorders *recorders, const Observation *seen, Error *err)
{
    for (int32_t k = 0; k < recorders->count; k++)
        if (!recorders->list[k].record(recorders->list[k].self, seen, err)) return false;
    return true;
}

bool window_record(void *self, const Observation *seen, Error *err)
{
    Window *window = self;
    const WindowDef *def = &window->def;
    bool open = seen->U >= def->from_U && seen->U <= def->to_U && seen->t >= def->from_t &&
                seen->t <= def->to_t;
    if (!open) return true;
    window->steps++;
    return recorders_record(&window->inside, seen, err);
}

void window_archive(Window *window, Archive *archive)
{
    archive_section(archive, "window");
    archive_integer(archive, &window->steps);
}
