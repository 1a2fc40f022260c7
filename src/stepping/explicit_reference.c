// SPDX-License-Identifier: GPL-2.0-or-later
// A step is first free of contact, friction and rod, by two products with sparse matrices; these
// three follow, node by node.
#include "stepping/explicit_reference.h"

#include "algebra/dense.h"
#include "base/memory.h"
#include "fem/floor.h"
#include "friction/friction.h"
#include "contact/slip.h"

#include <math.h>
#include <string.h>

bool explicit_reference_create(const ExplicitDef *def, ExplicitReference *scheme, Error *err)
{
    *scheme = (ExplicitReference){.def = *def};
    scheme->bound = NEW_ARRAY(double, def->interface->count, err);
    int64_t dofs = def->bulk->spectrum.count > 0 ? def->bulk->dof_count : 0;
    scheme->branch_work = NEW_ARRAY(double, dofs, err);
    scheme->branch_image = NEW_ARRAY(double, def->bulk->spectrum.count *dofs, err);
    int32_t all = def->bulk->dof_count;
    scheme->kick = NEW_ARRAY(double, all, err);
    scheme->u = NEW_ARRAY(double, all, err);
    scheme->v = NEW_ARRAY(double, all, err);
    scheme->u_next = NEW_ARRAY(double, all, err);
    scheme->v_next = NEW_ARRAY(double, all, err);
    scheme->elastic = NEW_ARRAY(double, all, err);
    scheme->viscous = NEW_ARRAY(double, all, err);
    if (dofs > 0) scheme->pull = NEW_ARRAY(double, dofs, err);
    if (!error_is_clean(err)) return false;
    for (int32_t k = 0; k < all; k++) scheme->kick[k] = def->step / def->bulk->mass[k];
    return true;
}

void explicit_reference_destroy(ExplicitReference *scheme)
{
    memory_free_all(scheme->bound, scheme->branch_work, scheme->branch_image, scheme->kick,
                    scheme->u, scheme->v, scheme->u_next, scheme->v_next, scheme->elastic,
                    scheme->viscous, scheme->pull);
    *scheme = (ExplicitReference){0};
}

// Puts motions and branches of a state into unknowns of nodes in the place of jumps, or back, by
// the two functions of fem/floor.
static void change_unknowns(const Mesh *mesh, void (*motion)(const Mesh *, double *),
                            void (*force)(const Mesh *, double *), State *state)
{
    if (!mesh) return;
    motion(mesh, state->displacement);
    motion(mesh, state->velocity);
    for (int32_t k = 0; k < state->branch_count; k++) {
        motion(mesh, state->stretch + (int64_t)k * state->dof_count);
        force(mesh, state->pull + (int64_t)k * state->dof_count);
    }
}

static void to_nodes(const Mesh *mesh, State *state)
{
    change_unknowns(mesh, floor_displace, floor_scatter, state);
}

static void to_jumps(const Mesh *mesh, State *state)
{
    change_unknowns(mesh, floor_find_jumps, floor_gather, state);
}

// Returns the floor node under a contact node, -1: the floor is rigid.
static int32_t node_under(const ExplicitReference *scheme, int32_t node)
{
    const Floor *floor = scheme->def.mesh ? &scheme->def.mesh->floor : &(const Floor){0};
    int32_t row = floor_start(floor, node);
    return row < floor_end(floor, node) ? floor->node[row] : -1;
}

// Returns the change of component d of a floor node's velocity by a unit force in a step; 0: it is
// held.
static double kick_under(const ExplicitReference *scheme, int32_t under, int32_t d)
{
    const Bulk *bulk = scheme->def.bulk;
    int32_t dof = under < 0 ? -1 : node_dof(bulk->dim, under, d);
    return dof < 0 || bulk->held[dof] ? 0 : scheme->kick[dof];
}

// sum [dofs] -= the reactions, and what they do to the floor.
static void subtract_reactions(const ExplicitReference *scheme, const State *state, double *sum)
{
    const Interface *interface = scheme->def.interface;
    for (int32_t k = 0; k < state->interface_count; k++)
        sum[interface->dofs[k]] -= state->reaction[k];
    for (int32_t i = 0; i < interface->contact_count; i++) {
        int32_t under = node_under(scheme, interface->node[i]);
        for (int32_t d = 0; under >= 0 && d < interface->dim; d++)
            sum[node_dof(interface->dim, under, d)] +=
                state->reaction[interface_unknown(interface, i, d)];
    }
}

// Finds the forces of all branches at t_n.
static void add_up_pulls(ExplicitReference *scheme, const State *state)
{
    double *sum = scheme->pull;
    if (!sum) return;
    memset(sum, 0, (size_t)state->dof_count * sizeof *sum);
    for (int32_t k = 0; k < state->branch_count; k++)
        for (int32_t d = 0; d < state->dof_count; d++)
            sum[d] += state->pull[(int64_t)k * state->dof_count + d];
}

// Brings branches to t_n+1 by the velocities v' of the step; returns the power that they dissipate,
// and adds their energies to the ledger's.
static double advance_branches(ExplicitReference *scheme, State *state, EnergyLedger *ledger)
{
    const Bulk *bulk = scheme->def.bulk;
    const Spectrum *spectrum = &bulk->spectrum;
    int32_t dofs = bulk->dof_count;
    double step = scheme->def.step, power = 0;
    const double *velocity = scheme->v_next;
    double *image = scheme->branch_work, *moved = scheme->branch_image;
    if (spectrum->count == 0) return 0;
    memset(moved, 0, (size_t)spectrum->count * (size_t)dofs * sizeof *moved);
    for (int32_t j = 0; j < spectrum->shape_count; j++) {
        sparse_apply(&bulk->pattern, j < spectrum->matrix_count ? bulk->shape[j] : bulk->stiffness,
                     velocity, image);
        for (int32_t k = 0; k < spectrum->count; k++)
            for (int32_t d = 0; spectrum->share[k][j] != 0 && d < dofs; d++)
                moved[(int64_t)k * dofs + d] += spectrum->share[k][j] * image[d];
    }
    for (int32_t k = 0; k < spectrum->count; k++) {
        double half = 0.5 * step / spectrum->time[k], sum = 0;
        double *stretch = state->stretch + (int64_t)k * dofs,
               *pull = state->pull + (int64_t)k * dofs;
        for (int32_t d = 0; d < dofs; d++) {
            double before = stretch[d], pulled = pull[d];
            stretch[d] = ((1 - half) * before + step * velocity[d]) / (1 + half);
            pull[d] = ((1 - half) * pulled + step * moved[(int64_t)k * dofs + d]) / (1 + half);
            sum += 0.25 * (before + stretch[d]) * (pulled + pull[d]);
        }
        power += sum / spectrum->time[k];
        ledger->branch[k].dissipated += step * sum / spectrum->time[k];
    }
    return power;
}

// Finds v half a step before the start, v_0 - (dt/2) a_0, with M a_0 = f + r - K u - C v from the
// equation itself: a load put on at once is not in the inertia of the state it is put on.
void explicit_reference_start(ExplicitReference *scheme, State *state)
{
    const Bulk *bulk = scheme->def.bulk;
    double *elastic = scheme->elastic, *viscous = scheme->viscous;
    scheme->time = state->time;
    scheme->rod_way = state->rod_way;
    scheme->steps = 0;
    to_nodes(scheme->def.mesh, state);
    sparse_apply(&bulk->pattern, bulk->stiffness, state->displacement, elastic);
    sparse_apply(&bulk->pattern, bulk->damping, state->velocity, viscous);
    add_up_pulls(scheme, state);
    for (int32_t k = 0; scheme->pull && k < bulk->dof_count; k++) elastic[k] += scheme->pull[k];
    subtract_reactions(scheme, state, elastic);
    for (int32_t k = 0; k < bulk->dof_count; k++) {
        double inertia = bulk->held[k] ? 0 : bulk->load[k] - elastic[k] - viscous[k];
        scheme->u[k] = state->displacement[k];
        scheme->v[k] = state->velocity[k] - 0.5 * scheme->kick[k] * inertia;
    }
    to_jumps(scheme->def.mesh, state);
}

// Returns w + strength mu(w) - free_speed, strength = (dt/m) r_n: by how much speed w exceeds what
// friction leaves of free_speed.
static double excess_speed(const FrictionNode *node, double free_speed, double strength,
                           double speed)
{
    return speed + strength * friction_coefficient(node, speed) - free_speed;
}

// Returns the speed that friction leaves of `free_speed`: the largest root of excess_speed; 0:
// sticks. Newton from the right goes down to it where the law is convex; else halving helps where a
// step leaves the interval that holds it. Both end where nothing is left between the ends of this
// interval. A node begins to slip where friction at rest cannot take all of free_speed in one step.
static double slip_speed(const FrictionNode *node, double free_speed, double strength, bool slipped)
{
    enum { EXCESS_PARTS = 64 };
    bool may_stick = free_speed <= strength * friction_coefficient(node, 0);
    bool convex = friction_is_convex(node->law);
    if (may_stick && (!slipped || (convex && 1 + strength * friction_slope(node, 0) > 0))) return 0;
    double speed = free_speed, low = 0, high = free_speed;

    // A law that is not convex: the highest of some parts of 0 to free_speed, at whose lower end
    // excess_speed is below 0, so that a root lies above. Where friction falls less than speed
    // rises, at every speed, excess_speed rises and the whole is one part.
    if (!convex) {
        int32_t parts = strength * friction_steepest(node) < 1 ? 1 : EXCESS_PARTS, k = parts - 1;
        while (k >= 0 && !(excess_speed(node, free_speed, strength, free_speed * k / parts) < 0))
            k--;
        if (k < 0) return 0;
        low = free_speed * k / parts;
    }
    do {
        double slope = 1 + strength * friction_slope(node, speed), before = speed;
        if (convex && slope <= 0) return 0;   // there is no root: it has come to rest
        double excess = excess_speed(node, free_speed, strength, speed);
        *(excess > 0 ? &high : &low) = speed;
        speed -= excess / slope;
        bool inside = (speed > low && speed < high) || speed == before;
        if (!convex && !inside) speed = 0.5 * (low + high);
        if (speed <= 0) return 0;
    } while (low < speed && speed < high);
    return speed;
}

// A force that changes v to v' in a step dissipates its work by their mean: to slip, and to
// the plastic impact of a node that arrives.
static double mean_power(double force, double before, double after)
{
    return 0.5 * force * (before + after);
}

// Moves contact node i; returns the power it dissipates. Places and velocities are those against
// the floor until the last lines.
static double resolve_contact(ExplicitReference *scheme, int32_t i, State *state)
{
    const Interface *interface = scheme->def.interface;
    int32_t t = interface_tangent(interface, i), last = interface->dim - 1;
    int32_t node = interface->node[i], under = node_under(scheme, node);
    double step = scheme->def.step, power = 0;
    double start[DIM_MAX], before[DIM_MAX], v[DIM_MAX];
    for (int32_t d = 0; d <= last; d++) {
        int32_t dof = node_dof(interface->dim, node, d);
        start[d] = scheme->u[dof];
        before[d] = scheme->v[dof];
        v[d] = scheme->v_next[dof];
        if (under < 0) continue;
        int32_t below = node_dof(interface->dim, under, d);
        start[d] -= scheme->u[below];
        before[d] -= scheme->v[below];
        v[d] -= scheme->v_next[below];
    }
    double kick = scheme->kick[node_dof(interface->dim, node, last)] +
                  kick_under(scheme, under, last);
    double *reaction = state->reaction + t, *slip_rate = state->slip_rate + t;
    double initial = interface_gap(interface, i);
    double gap = start[last] + initial, bound = -gap / step;
    bool open = v[last] >= bound;
    scheme->bound[t + last] = bound;

    // The law of the node in this step, at the states of its middle.
    FrictionNode *memory = scheme->def.stage_friction ? &scheme->def.stage_friction[i] : NULL;
    double *theta = state->theta + (int64_t)i * STATES_MAX;
    if (memory) friction_set_stage(memory, theta, 0.5 * step);

    // Open: no force. Pressed: friction takes speed from the free v, whose direction stays.
    if (open) {
        state->status[i] = CONTACT_OPEN;
        for (int32_t d = 0; d <= last; d++) reaction[d] = 0;
    } else {
        double strength = bound - v[last];   // (dt/m) r_n
        if (memory) friction_set_pressure(memory, strength / kick / interface->weight[i], 0);
        double free_speed = last == 1 ? fabs(v[0]) : hypot(v[0], v[1]), forward = 0;
        for (int32_t c = 0; c < last; c++) forward += slip_rate[c] * v[c];
        if (last == 1) forward = status_direction(state->status[i]) * v[0];
        bool slipped = status_slips(state->status[i]) && forward > 0;
        double speed =
            slip_speed(friction_at(scheme->def.friction, i), free_speed, strength, slipped);
        state->status[i] = speed == 0 ? CONTACT_STICK : status_of_slip(v[0]);
        for (int32_t c = 0; c < last; c++) {
            double left = speed == 0 ? copysign(0, v[c]) : speed * (v[c] / free_speed);
            reaction[c] = (left - v[c]) / kick;
            v[c] = left;
        }
        reaction[last] = strength / kick;
        v[last] = bound;
    }

    // Its motion, and the floor's under it.
    for (int32_t d = 0; d <= last; d++) {
        slip_rate[d] = v[d];
        power -= mean_power(reaction[d], before[d], v[d]);
        if (open) continue;
        int32_t dof = node_dof(interface->dim, node, d);
        double floor = 0;
        if (under >= 0) {
            int32_t below = node_dof(interface->dim, under, d);
            scheme->v_next[below] -= kick_under(scheme, under, d) * reaction[d];
            floor = scheme->u_next[below] = scheme->u[below] + step * scheme->v_next[below];
            v[d] += scheme->v_next[below];
        }
        scheme->u_next[dof] = d == last ? floor - initial
                                        : floor + (start[d] + step * slip_rate[d]);
        scheme->v_next[dof] = v[d];
    }

    // States at the end of the step.
    if (memory) {
        double middle[STATES_MAX];
        friction_state(memory, slip_size(interface, i, state->slip_rate), middle);
        for (int32_t k = 0; k < memory->law->states; k++) theta[k] = 2 * middle[k] - theta[k];
    }
    return power;
}

static bool rod_holds(const Rod *rod, double velocity, double bound)
{
    return rod->kind == ROD_IS_BONDED || (rod->kind == ROD_PUSHES && velocity < bound);
}

// Returns the compliance of node j to the rod: velocity per force/width.
static double rod_yields(const ExplicitReference *scheme, int32_t j)
{
    const Rod *rod = scheme->def.rod;
    return rod->softness[j] / (scheme->def.step + rod->lag[j]);
}

// Finds the bounds of the rod's nodes for a step that ends at `time`. Those of a rod on a spring
// are moved by its own velocity w, at which sum_j r_j(w) + dt k w = k (U - R): the left side rises
// piecewise linearly and is convex, so that Newton ends at the root with the set of nodes that it
// met last.
static void lead_rod(ExplicitReference *scheme, double time)
{
    const Interface *interface = scheme->def.interface;
    const Rod *rod = scheme->def.rod;
    double step = scheme->def.step, own = 0, *bound = scheme->bound;
    for (int32_t j = 0; j < interface->rod_count; j++) {
        double at = scheme->u[node_dof(interface->dim, interface->rod_node[j], 0)];
        bound[interface_rod(interface, j)] =
            rod->stiffness > 0 ? rod_bound_on_spring(rod, j, at, scheme->rod_way, step)
                               : rod_bound(rod, j, at, time, step);
    }
    if (rod->stiffness == 0) return;
    double force = rod->stiffness * (rod_displacement(rod, time) - scheme->rod_way);
    for (int32_t k = 0, before = -1, touching = -2;
         before != touching && k < interface->rod_count + 2; k++) {
        double given = force, resists = step * rod->stiffness;
        before = touching;
        touching = 0;
        for (int32_t j = 0; j < interface->rod_count; j++) {
            int32_t x = interface_rod(interface, j);
            int32_t dof = node_dof(interface->dim, interface->rod_node[j], 0);
            double velocity = scheme->v_next[dof];
            if (k > 0 && !rod_holds(rod, velocity, bound[x] + own)) continue;
            double share = 1 / (scheme->kick[dof] + rod_yields(scheme, j));
            given -= share * (bound[x] - velocity);
            resists += share;
            touching++;
        }
        own = given / resists;
    }
    for (int32_t j = 0; j < interface->rod_count; j++) bound[interface_rod(interface, j)] += own;
    scheme->rod_way += step * own;
}

// Finds u and v a step later as if nothing were touched. Returns v C v, the viscous power.
static double advance_free(ExplicitReference *scheme)
{
    const Bulk *bulk = scheme->def.bulk;
    double power = 0;
    sparse_apply(&bulk->pattern, bulk->stiffness, scheme->u, scheme->elastic);
    sparse_apply(&bulk->pattern, bulk->damping, scheme->v, scheme->viscous);
    for (int32_t k = 0; k < bulk->dof_count; k++) {
        double force = scheme->factor * bulk->load[k] - scheme->elastic[k] - scheme->viscous[k];
        if (scheme->pull) force -= scheme->pull[k];
        power += scheme->v[k] * scheme->viscous[k];
        scheme->v_next[k] = scheme->v[k] + scheme->kick[k] * force;
        scheme->u_next[k] = scheme->u[k] + scheme->def.step * scheme->v_next[k];
    }
    return power;
}

// Does one step; its powers go to the ledger.
static void advance_once(ExplicitReference *scheme, State *state, EnergyLedger *ledger)
{
    const Interface *interface = scheme->def.interface;
    const Bulk *bulk = scheme->def.bulk;
    double step = scheme->def.step, frictional = 0, pushed = 0, loaded = 0;
    scheme->factor = load_factor(scheme->def.course, scheme->time + step * (double)scheme->steps);
    add_up_pulls(scheme, state);
    double viscous = advance_free(scheme);
    for (int32_t i = 0; i < interface->contact_count; i++)
        frictional += resolve_contact(scheme, i, state);

    // The rod's nodes.
    lead_rod(scheme, scheme->time + step * (double)(scheme->steps + 1));
    for (int32_t j = 0; j < interface->rod_count; j++) {
        int32_t x = interface_rod(interface, j);
        int32_t dof = node_dof(interface->dim, interface->rod_node[j], 0);
        double *v = &scheme->v_next[dof];
        double bound = scheme->bound[x], yields = rod_yields(scheme, j), force = 0;
        bool touches = rod_holds(scheme->def.rod, *v, bound);
        if (touches) {   // v' = v + kick r = bound - yields r
            force = (bound - *v) / (scheme->kick[dof] + yields);
            *v = bound - yields * force;
            scheme->u_next[dof] = scheme->u[dof] + step * *v;
        }
        state->rod_touches[j] = touches;
        state->reaction[x] = force;
        state->slip_rate[x] = *v;
        // The rod's power, and what of it is lost where the face is hit.
        double given = force * *v;
        frictional += given - mean_power(force, scheme->v[dof], *v);
        pushed += given;
    }

    // Branches of the materials, and the power of a load that changes, by velocities at the end.
    viscous += advance_branches(scheme, state, ledger);
    for (int32_t k = 0; scheme->def.course && k < bulk->dof_count; k++)
        loaded += bulk->load[k] * scheme->v_next[k];
    ledger->viscous += step * viscous;
    ledger->frictional += step * frictional;
    ledger->rod_work += step * pushed;
    scheme->load_work += step * (scheme->factor * loaded);
    scheme->steps++;
}

bool explicit_reference_advance(ExplicitReference *scheme, int64_t steps, State *state,
                                EnergyLedger *ledger, Error *err)
{
    const Bulk *bulk = scheme->def.bulk;
    int32_t dofs = bulk->dof_count;
    double step = scheme->def.step, load_work = 0;
    to_nodes(scheme->def.mesh, state);
    for (int64_t k = 0; k < steps; k++) {
        advance_once(scheme, state, ledger);
        double *spare_u = scheme->u, *spare_v = scheme->v;
        scheme->u = scheme->u_next;
        scheme->v = scheme->v_next;
        scheme->u_next = spare_u;
        scheme->v_next = spare_v;
    }

    // The last step as a state of nodes; v_next still holds the v before it.
    for (int32_t k = 0; k < dofs; k++) {
        load_work += bulk->load[k] * (scheme->u[k] - state->displacement[k]);
        state->displacement[k] = scheme->u[k];
        state->velocity[k] = scheme->v[k];
        state->momentum[k] = bulk->mass[k] * scheme->v[k];
        state->inertia[k] = (scheme->v[k] - scheme->v_next[k]) / scheme->kick[k];
    }
    sparse_apply(&bulk->pattern, bulk->stiffness, state->displacement, state->elastic_force);
    state->time = scheme->time + step * (double)scheme->steps;
    state->rod_way = scheme->rod_way;
    ledger->load_work += scheme->def.course ? scheme->load_work : load_work;
    scheme->load_work = 0;
    energy_store(state, ledger);
    if (!isfinite(ledger->elastic) || !isfinite(ledger->kinetic))
        return FAULT(
            err, ERROR_COMPUTE,
            "the explicit steps of %g have blown up before t = %g: they are longer than is stable",
            step, state->time);

    // The largest |M a + C (v + v')/2 + K u_n + sum_k K_k e_k,n - f - r_n|.
    double *field = scheme->u_next, *sum = scheme->elastic, *viscous = scheme->viscous;
    for (int32_t k = 0; k < dofs; k++)
        field[k] = state->velocity[k] - 0.5 * scheme->kick[k] * state->inertia[k];
    sparse_apply(&bulk->pattern, bulk->damping, field, viscous);
    for (int32_t k = 0; k < dofs; k++)
        field[k] = state->displacement[k] - step * state->velocity[k];
    sparse_apply(&bulk->pattern, bulk->stiffness, field, sum);
    for (int32_t k = 0; k < dofs; k++)
        sum[k] += state->inertia[k] + viscous[k] - scheme->factor * bulk->load[k];
    for (int32_t k = 0; scheme->pull && k < dofs; k++) sum[k] += scheme->pull[k];
    subtract_reactions(scheme, state, sum);
    scheme->residual = dense_max_abs(sum, dofs);

    to_jumps(scheme->def.mesh, state);
    double *const forces[] = {state->momentum, state->inertia, state->elastic_force};
    for (int k = 0; k < 3 && scheme->def.mesh; k++) floor_gather(scheme->def.mesh, forces[k]);
    return true;
}

void explicit_reference_archive(ExplicitReference *scheme, Archive *archive)
{
    archive_section(archive, "explicit steps");
    archive_numbers_of(archive, &scheme->time, &scheme->rod_way);
    archive_count(archive, &scheme->steps);
    archive_number(archive, &scheme->residual);
    archive_numbers(archive, scheme->u, scheme->u ? scheme->def.bulk->dof_count : 0);
    archive_numbers(archive, scheme->v, scheme->v ? scheme->def.bulk->dof_count : 0);
    archive_numbers(archive, scheme->bound, scheme->bound ? scheme->def.interface->count : 0);
}
