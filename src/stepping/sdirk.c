// SPDX-License-Identifier: GPL-2.0-or-later
#include "stepping/sdirk.h"

#include "algebra/dense.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

bool sdirk_create(const Block *block, TableauKind kind, Ladder *ladder, Sdirk *scheme, Error *err)
{
    const BulkOperator *system = block->system;
    const Interface *interface = block->interface;
    *scheme = (Sdirk){.tableau = tableau_of(kind),
                      .system = block->system,
                      .interface = interface,
                      .friction = block->friction,
                      .rod = block->rod,
                      .ladder = ladder};
    scheme->rhs = NEW_ARRAY(double, system->dof_count, err);
    scheme->force = NEW_ARRAY(double, system->dof_count, err);
    scheme->viscous = NEW_ARRAY(double, system->dof_count, err);
    int64_t earlier = scheme->tableau.stages - 1, dofs = system->dof_count;
    ladder->gamma = scheme->tableau.gamma;
    scheme->stage_velocity = NEW_ARRAY(double, earlier *dofs, err);
    scheme->stage_impulse = NEW_ARRAY(double, earlier *dofs, err);
    scheme->stage_elastic = NEW_ARRAY(double, scheme->tableau.stages *dofs, err);
    scheme->stage_reaction = NEW_ARRAY(double, earlier * interface->count, err);
    scheme->predictor = NEW_ARRAY(double, system->dof_count, err);
    scheme->g = NEW_ARRAY(double, interface->count, err);
    scheme->bound = NEW_ARRAY(double, interface->count, err);
    if (!error_is_clean(err) || !friction_states_create(block, &scheme->memory, err)) return false;
    return contact_solver_create(interface, &scheme->solver, err);
}

void sdirk_destroy(Sdirk *scheme)
{
    contact_solver_destroy(&scheme->solver);
    friction_states_destroy(&scheme->memory);
    memory_free_all(scheme->rhs, scheme->force, scheme->viscous, scheme->predictor, scheme->g,
                    scheme->bound, scheme->stage_velocity, scheme->stage_impulse,
                    scheme->stage_elastic, scheme->stage_reaction);
    *scheme = (Sdirk){0};
}

// A step on its way: the rung's step and matrix, and where it starts and ends.
typedef struct Trial {
    double step, scaled;   // dt, gamma dt
    int32_t rung;
    const State *from;
    State *to;
    StepOutcome *outcome;
} Trial;

// Every so many steps the end state is put into the full equation, every term computed anew.
enum { AUDIT_EVERY = 32 };

// bound = (position to reach at `time` - u*) / (gamma dt): the plane for normals, the rod for rods.
// Those of a rod on a spring are for velocities against it, until they are released.
static void fill_bounds(Sdirk *scheme, const double *predictor, double time, double scaled_step)
{
    const Interface *interface = scheme->interface;
    const int32_t *dofs = scheme->system->interface_dofs;
    scheme->reach = scaled_step;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        int32_t n = interface_normal(interface, i);
        scheme->bound[n] = (-predictor[dofs[n]] - interface_gap(interface, i)) / scaled_step;
    }
    for (int32_t j = 0; j < interface->rod_count; j++) {
        int32_t x = interface_rod(interface, j);
        double at = predictor[dofs[x]];
        bool rigid = scheme->rod->stiffness == 0;
        scheme->bound[x] =
            rigid ? rod_bound(scheme->rod, j, at, time, scaled_step)
                  : rod_bound_on_spring(scheme->rod, j, at, scheme->rod_start, scaled_step);
    }
}

// k (U - R*): the spring's force at the end of the stage, had the rod no velocity.
static void pull_rod(const Sdirk *scheme, int32_t rung, double time)
{
    const Rod *rod = scheme->rod;
    if (rod->stiffness == 0) return;
    interface_operator_pull(scheme->ladder->rung[rung],
                            rod->stiffness * (rod_displacement(rod, time) - scheme->rod_start));
}

// Velocities found against a rod on a spring, and their bounds, become those in space. Returns the
// rod's own; 0 of one that goes where it is driven.
static double release_rod(Sdirk *scheme, const InterfaceOperator *bulk, double *velocity)
{
    if (scheme->rod->stiffness == 0) return 0;
    double own = interface_operator_release(bulk, velocity);
    for (int32_t j = 0; j < scheme->interface->rod_count; j++)
        scheme->bound[interface_rod(scheme->interface, j)] += own;
    return own;
}

// A law that asks for pressure takes at most so many problems in a row, each with the pressures of
// the one before.
enum { PRESSURES_LIMIT = 40 };

// The whole contact, or one side of it. Whether it was settled.
static bool settle(Sdirk *scheme, const ContactProblem *problem, ContactSolution *contact,
                   bool *lopsided)
{
    if (scheme->ladder->side == LADDER_WHOLE)
        return contact_solve(&scheme->solver, problem, contact);
    bool alike, solved = half_step_solve(scheme->half, problem, scheme->odd, contact, &alike);
    contact_solver_take_counts(&scheme->solver, &scheme->half->solver);
    *lopsided = !alike;
    return solved;
}

// Solves A v = rhs + r with the interface's conditions, stage i. *solved says whether contact was
// settled.
static bool solve_stage(Sdirk *scheme, const Trial *trial, int32_t i, ContactSolution *contact,
                        double *v, Error *err)
{
    int32_t rung = trial->rung;
    bool *solved = &trial->outcome->solved;
    InterfaceOperator *bulk = scheme->ladder->rung[rung];
    const Interface *interface = scheme->interface;
    TRY(interface_operator_condense(bulk, scheme->rhs, scheme->g, err));
    ContactProblem problem = {.interface = interface,
                              .friction = scheme->friction,
                              .rod_kind = scheme->rod->kind,
                              .rod_softness = scheme->rod->softness,
                              .rod_lag = scheme->rod->lag,
                              .rod_reach = scheme->reach,
                              .matrix = ladder_contact(scheme->ladder, rung),
                              .g = scheme->g,
                              .bound = scheme->bound};
    *solved = settle(scheme, &problem, contact, &trial->outcome->lopsided);
    int32_t again = PRESSURES_LIMIT;
    while (*solved && friction_states_press(&scheme->memory, contact->velocity, contact->reaction))
        *solved = again-- > 0 && settle(scheme, &problem, contact, &trial->outcome->lopsided);
    if (!*solved) goto cleanup;
    scheme->rod_rate[i] = release_rod(scheme, bulk, contact->velocity);
    TRY(interface_operator_expand(bulk, contact->velocity, v, err));
    // Held nodes are held exactly, not to the rounding of the substitution.
    for (int32_t k = 0; k < interface->count; k++)
        v[scheme->system->interface_dofs[k]] = contact->velocity[k];
cleanup:
    return error_is_clean(err);
}

// y += factor x. Not BLAS's, whose fused multiply-adds round otherwise: a block of period 2 can
// then pass for one of period 1, its rounds being near each other.
static void add_scaled(double factor, const double *x, int32_t count, double *y)
{
    for (int32_t k = 0; k < count; k++) y[k] += factor * x[k];
}

// Size of the local error of u, as stepping/tableau estimates it.
static double estimate_error(Sdirk *scheme, const State *from, const State *to, double step)
{
    const Tableau *tableau = &scheme->tableau;
    int32_t dofs = scheme->system->dof_count, stages = tableau->stages;
    double *error = scheme->rhs;
    for (int32_t k = 0; k < dofs; k++)
        error[k] = step * (tableau->error[0] * from->velocity[k] +
                           tableau->error[stages] * to->velocity[k]);
    for (int32_t i = 0; i + 1 < stages; i++)
        add_scaled(step * tableau->error[i + 1], scheme->stage_velocity + (int64_t)i * dofs, dofs,
                   error);
    return bulk_operator_size(scheme->system, error);
}

// scheme->viscous = C v of a stage that was solved, from its own equation: rhs + r - M v/(gamma dt)
// - gamma dt K v, given M v and K v.
static void find_viscous(Sdirk *scheme, const double *momentum, const double *elastic,
                         const ContactSolution *contact, double scaled)
{
    const BulkOperator *system = scheme->system;
    double *viscous = scheme->viscous, rate = 1 / scaled;
    for (int32_t i = 0; i < system->dof_count; i++)
        viscous[i] = scheme->rhs[i] - rate * momentum[i] - scaled * elastic[i];
    for (int32_t k = 0; k < system->interface_count; k++)
        viscous[system->interface_dofs[k]] += contact->reaction[k];
}

// Largest |M a + C v + K u - f - r|, C v and K u computed for it. K u stays: what the steps add up
// of it must not drift.
static double end_residual(const Sdirk *scheme, State *to)
{
    const BulkOperator *system = scheme->system;
    double *viscous = scheme->viscous, factor = load_factor(scheme->course, to->time);
    bulk_operator_apply(system, BULK_DAMPING, to->velocity, viscous);
    bulk_operator_apply(system, BULK_STIFFNESS, to->displacement, to->elastic_force);
    for (int32_t k = 0; k < to->dof_count; k++)
        viscous[k] += to->inertia[k] + to->elastic_force[k] - factor * system->load[k];
    for (int32_t k = 0; k < to->interface_count; k++)
        viscous[system->interface_dofs[k]] -= to->reaction[k];
    return dense_max_abs(viscous, to->dof_count);
}

// The contact as it was, a first guess for the stages.
static void guess_contact(const State *from, State *to)
{
    size_t bytes = (size_t)from->interface_count * sizeof(double);
    memcpy(to->status, from->status, (size_t)from->contact_count);
    memcpy(to->rod_touches, from->rod_touches, (size_t)from->rod_count);
    memcpy(to->slip_rate, from->slip_rate, bytes);
    memcpy(to->reaction, from->reaction, bytes);
}

// Puts the start of stage i into its arrays: u_i* into scheme->predictor, K u_i* into
// scheme->force, M w_i into to->inertia.
static void start_stage(Sdirk *scheme, const Trial *trial, int32_t i)
{
    const State *from = trial->from;
    int32_t dofs = from->dof_count;
    size_t bytes = (size_t)dofs * sizeof(double);
    memcpy(scheme->predictor, from->displacement, bytes);
    memcpy(scheme->force, from->elastic_force, bytes);
    memcpy(trial->to->inertia, from->momentum, bytes);
    scheme->rod_start = from->rod_way;
    for (int32_t j = 0; j < i; j++) {
        double weight = scheme->tableau.a[i][j];
        const double *velocity = scheme->stage_velocity + (int64_t)j * dofs;
        const double *elastic = scheme->stage_elastic + (int64_t)j * dofs;
        const double *impulse = scheme->stage_impulse + (int64_t)j * dofs;
        add_scaled(trial->step * weight, velocity, dofs, scheme->predictor);
        add_scaled(trial->step * weight, elastic, dofs, scheme->force);
        add_scaled(weight, impulse, dofs, trial->to->inertia);
        scheme->rod_start += trial->step * weight * scheme->rod_rate[j];
    }
}

// The last stage is the end of the step: everything else that the state holds.
static void end_step(Sdirk *scheme, const Trial *trial)
{
    const BulkOperator *system = scheme->system;
    State *to = trial->to;
    const double *elastic = scheme->stage_elastic +
                            (int64_t)(scheme->tableau.stages - 1) * to->dof_count;
    double rate = 1 / trial->scaled;
    to->time = trial->from->time + trial->step;
    to->rod_way = scheme->rod_start + trial->scaled * scheme->rod_rate[scheme->tableau.stages - 1];
    for (int32_t k = 0; k < to->dof_count; k++) {
        to->displacement[k] = scheme->predictor[k] + trial->scaled * to->velocity[k];
        to->elastic_force[k] = scheme->force[k] + trial->scaled * elastic[k];
        to->inertia[k] = rate * (to->momentum[k] - to->inertia[k]);
        trial->outcome->load_work += system->load[k] *
                                     (to->displacement[k] - trial->from->displacement[k]);
    }
}

// Stage i: v_i, and what later stages and the ledger need of it.
static bool solve_one_stage(Sdirk *scheme, const Trial *trial, int32_t i, Error *err)
{
    BulkOperator *system = scheme->system;
    const Tableau *tableau = &scheme->tableau;
    State *to = trial->to;
    int32_t dofs = system->dof_count, count = to->interface_count;
    bool last = i + 1 == tableau->stages;
    double *velocity = last ? to->velocity : scheme->stage_velocity + (int64_t)i * dofs;
    double *momentum = last ? to->momentum : scheme->stage_impulse + (int64_t)i * dofs;
    double *elastic = scheme->stage_elastic + (int64_t)i * dofs, rate = 1 / trial->scaled;
    ContactSolution contact = {.velocity = to->slip_rate,
                               .reaction = to->reaction,
                               .status = to->status,
                               .rod_touches = to->rod_touches};
    double time = trial->from->time + tableau->c[i] * trial->step;
    double factor = load_factor(scheme->course, time);
    start_stage(scheme, trial, i);
    for (int32_t k = 0; k < dofs; k++)
        scheme->rhs[k] = rate * to->inertia[k] + system->load[k] - scheme->force[k];
    if (scheme->course) add_scaled(factor - 1, system->load, dofs, scheme->rhs);
    fill_bounds(scheme, scheme->predictor, time, trial->scaled);
    pull_rod(scheme, trial->rung, time);
    friction_states_start_stage(&scheme->memory, tableau, trial->step, i, trial->from);
    TRY(solve_stage(scheme, trial, i, &contact, velocity, err));
    if (!trial->outcome->solved) goto cleanup;
    friction_states_end_stage(&scheme->memory, i, to);
    bulk_operator_apply(system, BULK_MASS, velocity, momentum);
    bulk_operator_apply(system, BULK_STIFFNESS, velocity, elastic);
    find_viscous(scheme, momentum, elastic, &contact, trial->scaled);
    if (scheme->course)   // by stages, beyond the work of the load as it was
        trial->outcome->load_work += trial->step * tableau->a[tableau->stages - 1][i] *
                                     (factor - 1) * dense_dot(system->load, velocity, dofs);
    trial->outcome->power[i] =
        energy_stage(scheme->interface, velocity, scheme->viscous, dofs, &contact);
    if (last) {
        end_step(scheme, trial);
        goto cleanup;
    }
    for (int32_t k = 0; k < dofs; k++)
        momentum[k] = (momentum[k] - to->inertia[k]) / tableau->gamma;
    memcpy(scheme->stage_reaction + (int64_t)i * count, to->reaction,
           (size_t)count * sizeof(double));
cleanup:
    return error_is_clean(err);
}

// Before the stages, as it may make the rung anew. false: it cannot be had.
static bool find_odd(Sdirk *scheme, int32_t k)
{
    bool acts = scheme->odd_acts && scheme->ladder->side != LADDER_WHOLE;
    scheme->odd = acts ? ladder_contact_of(scheme->ladder, k, LADDER_ODD) : NULL;
    return !acts || scheme->odd || scheme->ladder->side == LADDER_WHOLE;
}

bool sdirk_step(Sdirk *scheme, int32_t k, const State *from, State *to, StepOutcome *outcome,
                Error *err)
{
    *outcome = (StepOutcome){0};
    Trial trial = {.step = ladder_step(scheme->ladder, k),
                   .scaled = ladder_reach(scheme->ladder, k),
                   .rung = k,
                   .from = from,
                   .to = to,
                   .outcome = outcome};
    if (!ladder_rung(scheme->ladder, k, err) || !find_odd(scheme, k)) goto cleanup;
    guess_contact(from, to);
    friction_states_begin(&scheme->memory, from);
    for (int32_t i = 0; i < scheme->tableau.stages; i++) {
        TRY(solve_one_stage(scheme, &trial, i, err));
        if (!outcome->solved) goto cleanup;
    }
    outcome->error = estimate_error(scheme, from, to, trial.step);
    double forgets = friction_states_error(&scheme->memory, &scheme->tableau, trial.step);
    if (forgets > outcome->error) outcome->error = forgets;
    bool audited = scheme->steps++ % AUDIT_EVERY == 0;
    outcome->residual = audited ? end_residual(scheme, to) : 0;
cleanup:
    return error_is_clean(err);
}

void sdirk_add_energy(const Sdirk *scheme, const StepOutcome *outcome, double step,
                      EnergyLedger *ledger)
{
    int32_t stages = scheme->tableau.stages;
    for (int32_t i = 0; i < stages; i++) {
        double weight = step * scheme->tableau.a[stages - 1][i];
        ledger->rod_work += weight * outcome->power[i].rod;
        ledger->viscous += weight * outcome->power[i].viscous;
        ledger->frictional += weight * outcome->power[i].frictional;
    }
    ledger->load_work += outcome->load_work;
}

void sdirk_archive(Sdirk *scheme, Archive *archive)
{
    archive_section(archive, "scheme");
    archive_numbers(archive, scheme->bound, scheme->interface->count);
    archive_number(archive, &scheme->reach);
    archive_count(archive, &scheme->steps);
    friction_states_archive(&scheme->memory, archive);
    contact_solver_archive(&scheme->solver, scheme->interface, archive);
}
