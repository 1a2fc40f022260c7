// SPDX-License-Identifier: GPL-2.0-or-later
#include "stepping/sdirk.h"

#include "algebra/dense.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

bool sdirk_create(const Block *block, DtLevels *dt_levels, Sdirk *scheme, Error *err)
{
    const BulkOperator *system = block->system;
    const Interface *interface = block->interface;
    *scheme = (Sdirk){.system = block->system,
                      .interface = interface,
                      .friction = block->friction,
                      .rod = block->rod,
                      .dt_levels = dt_levels};
    scheme->rhs = NEW_ARRAY(double, system->dof_count, err);
    scheme->force = NEW_ARRAY(double, system->dof_count, err);
    scheme->viscous = NEW_ARRAY(double, system->dof_count, err);
    int64_t earlier = SDIRK_STAGES - 1, dofs = system->dof_count;
    scheme->stage_velocity = NEW_ARRAY(double, earlier *dofs, err);
    scheme->stage_impulse = NEW_ARRAY(double, earlier *dofs, err);
    scheme->stage_elastic = NEW_ARRAY(double, SDIRK_STAGES *dofs, err);
    scheme->stage_reaction = NEW_ARRAY(double, earlier * interface->count, err);
    scheme->predictor = NEW_ARRAY(double, system->dof_count, err);
    scheme->g = NEW_ARRAY(double, interface->count, err);
    scheme->bound = NEW_ARRAY(double, interface->count, err);
    if (!error_is_clean(err) || !friction_states_create(block, &scheme->memory, err)) return false;
    if (!branches_create(system, &scheme->branches, err)) return false;
    return contact_solver_create(interface, &scheme->solver, err);
}

void sdirk_destroy(Sdirk *scheme)
{
    contact_solver_destroy(&scheme->solver);
    friction_states_destroy(&scheme->memory);
    branches_destroy(&scheme->branches);
    memory_free_all(scheme->rhs, scheme->force, scheme->viscous, scheme->predictor, scheme->g,
                    scheme->bound, scheme->stage_velocity, scheme->stage_impulse,
                    scheme->stage_elastic, scheme->stage_reaction);
    *scheme = (Sdirk){0};
}

// Every so many steps the end state is put into the full equation, every term computed anew.
enum { AUDIT_EVERY = 32 };

// A law that asks for pressure takes at most so many problems in a row, each with the pressures of
// the one before.
enum { PRESSURES_LIMIT = 40 };

// The whole contact, or its symmetric part on one side. false: it has no solution that was found.
static bool solve_contact(Sdirk *scheme, const ContactProblem *problem, ContactSolution *contact,
                          bool *asymmetric)
{
    if (scheme->part == PART_WHOLE) return contact_solve(&scheme->solver, problem, contact);
    bool alike,
        solved = half_step_solve(scheme->half, problem, scheme->antisymmetric, contact, &alike);
    contact_solver_take_counts(&scheme->solver, &scheme->half->solver);
    *asymmetric = !alike;
    return solved;
}

// y += factor x. Not BLAS's, whose fused multiply-adds round otherwise: a block of period 2 can
// then pass for one of period 1, its rounds being near each other.
static void add_scaled(double factor, const double *x, int32_t count, double *y)
{
    for (int32_t k = 0; k < count; k++) y[k] += factor * x[k];
}

// Solves stage i of a step with level k: v_i, and what later stages, the ledger and, of the last
// stage, the end state need of it.
static bool solve_stage(Sdirk *scheme, int32_t k, int32_t i, const State *from, State *to,
                        StepOutcome *outcome, Error *err)
{
    BulkOperator *system = scheme->system;
    InterfaceOperator *bulk = scheme->dt_levels->level[k];
    const Interface *interface = scheme->interface;
    Rod *rod = scheme->rod;
    const int32_t *interface_dofs = system->interface_dofs;
    int32_t dofs = system->dof_count, count = to->interface_count;
    size_t bytes = (size_t)dofs * sizeof(double);
    bool last = i + 1 == SDIRK_STAGES, sprung = rod->stiffness != 0;
    double *velocity = last ? to->velocity : scheme->stage_velocity + (int64_t)i * dofs;
    double *momentum = last ? to->momentum : scheme->stage_impulse + (int64_t)i * dofs;
    double *elastic = scheme->stage_elastic + (int64_t)i * dofs;
    double step = dt_level_step(scheme->dt_levels, k),
           scaled = dt_level_reach(scheme->dt_levels, k);
    double rate = 1 / scaled;   // 1/(gamma dt)
    double time = from->time + SDIRK2.c[i] * step;
    double factor = load_factor(scheme->course, time);

    // Start of the stage: u_i* goes into scheme->predictor, K u_i* into scheme->force, M w_i into
    // to->inertia.
    memcpy(scheme->predictor, from->displacement, bytes);
    memcpy(scheme->force, from->elastic_force, bytes);
    memcpy(to->inertia, from->momentum, bytes);
    scheme->rod_start = from->rod_way;
    for (int32_t j = 0; j < i; j++) {
        double weight = SDIRK2.a[i][j];
        add_scaled(step * weight, scheme->stage_velocity + (int64_t)j * dofs, dofs,
                   scheme->predictor);
        add_scaled(step * weight, scheme->stage_elastic + (int64_t)j * dofs, dofs, scheme->force);
        add_scaled(weight, scheme->stage_impulse + (int64_t)j * dofs, dofs, to->inertia);
        scheme->rod_start += step * weight * scheme->rod_rate[j];
    }

    // The right-hand side: inertia, load, and the elastic force of the start.
    for (int32_t d = 0; d < dofs; d++)
        scheme->rhs[d] = rate * to->inertia[d] + system->load[d] - scheme->force[d];
    if (scheme->course) add_scaled(factor - 1, system->load, dofs, scheme->rhs);

    branches_start_stage(&scheme->branches, step, i, from, to, scheme->rhs);

    // bound = (position to reach - u*)/(gamma dt): the plane for normals, the rod for rod nodes.
    // Those of a rod on a spring are for velocities against it, until they are released below.
    scheme->reach = scaled;
    for (int32_t c = 0; c < interface->contact_count; c++) {
        int32_t n = interface_normal(interface, c);
        scheme->bound[n] = (-scheme->predictor[interface_dofs[n]] - interface_gap(interface, c)) /
                           scaled;
    }
    for (int32_t j = 0; j < interface->rod_count; j++) {
        int32_t x = interface_rod(interface, j);
        double at = scheme->predictor[interface_dofs[x]];
        scheme->bound[x] = sprung ? rod_bound_on_spring(rod, j, at, scheme->rod_start, scaled)
                                  : rod_bound(rod, j, at, time, scaled);
    }
    // k (U - R*): the spring's force at the end of the stage, had the rod no velocity.
    if (sprung)
        interface_operator_pull(bulk,
                                rod->stiffness * (rod_displacement(rod, time) - scheme->rod_start));
    friction_states_start_stage(&scheme->memory, step, i, from);

    // A v = rhs + r, condensed on the interface, with the conditions of contact. A law that asks
    // for pressure is solved again with the pressures that were found.
    TRY(interface_operator_condense(bulk, scheme->rhs, scheme->g, err));
    ContactSolution contact = {.velocity = to->slip_rate,
                               .reaction = to->reaction,
                               .status = to->status,
                               .rod_touches = to->rod_touches};
    ContactProblem problem = {.interface = interface,
                              .friction = scheme->friction,
                              .rod_kind = rod->kind,
                              .rod_softness = rod->softness,
                              .rod_lag = rod->lag,
                              .rod_reach = scheme->reach,
                              .matrix = dt_level_contact(scheme->dt_levels, k, scheme->part),
                              .g = scheme->g,
                              .bound = scheme->bound};
    outcome->solved = solve_contact(scheme, &problem, &contact, &outcome->asymmetric);
    int32_t again = PRESSURES_LIMIT;
    while (outcome->solved &&
           friction_states_press(&scheme->memory, contact.velocity, contact.reaction))
        outcome->solved = again-- > 0 &&
                          solve_contact(scheme, &problem, &contact, &outcome->asymmetric);
    if (!outcome->solved) goto cleanup;

    // Velocities found against a rod on a spring, and their bounds, become those in space.
    scheme->rod_rate[i] = sprung ? interface_operator_release(bulk, contact.velocity) : 0;
    for (int32_t j = 0; sprung && j < interface->rod_count; j++)
        scheme->bound[interface_rod(interface, j)] += scheme->rod_rate[i];
    TRY(interface_operator_expand(bulk, contact.velocity, velocity, err));
    // Held nodes are held exactly, not to the rounding of the substitution.
    for (int32_t c = 0; c < count; c++) velocity[interface_dofs[c]] = contact.velocity[c];
    friction_states_end_stage(&scheme->memory, i, to);

    // C v of the stage, from its own equation: rhs + r - M v/(gamma dt) - gamma dt K v.
    bulk_operator_apply(system, BULK_MASS, velocity, momentum);
    bulk_operator_apply(system, BULK_STIFFNESS, velocity, elastic);
    for (int32_t d = 0; d < dofs; d++)
        scheme->viscous[d] = scheme->rhs[d] - rate * momentum[d] - scaled * elastic[d];
    for (int32_t c = 0; c < count; c++) scheme->viscous[interface_dofs[c]] += contact.reaction[c];

    double relaxed = branches_end_stage(&scheme->branches, step, i, velocity, elastic, to,
                                        scheme->viscous, outcome->relaxed);

    // Powers. The load's work beyond that of the load as it was goes by stages.
    if (scheme->course)
        outcome->load_work += step * SDIRK2.a[SDIRK_STAGES - 1][i] * (factor - 1) *
                              dense_dot(system->load, velocity, dofs);
    outcome->power[i] = energy_stage(interface, velocity, scheme->viscous, dofs, &contact);
    outcome->power[i].viscous += relaxed;

    if (!last) {   // dt M a_i and r_i, for later stages
        for (int32_t d = 0; d < dofs; d++)
            momentum[d] = (momentum[d] - to->inertia[d]) / SDIRK2.gamma;
        memcpy(scheme->stage_reaction + (int64_t)i * count, to->reaction,
               (size_t)count * sizeof(double));
        goto cleanup;
    }
    // The last stage is the end of the step.
    to->time = from->time + step;
    to->rod_way = scheme->rod_start + scaled * scheme->rod_rate[i];
    for (int32_t d = 0; d < dofs; d++) {
        to->displacement[d] = scheme->predictor[d] + scaled * to->velocity[d];
        to->elastic_force[d] = scheme->force[d] + scaled * elastic[d];
        to->inertia[d] = rate * (to->momentum[d] - to->inertia[d]);
        outcome->load_work += system->load[d] * (to->displacement[d] - from->displacement[d]);
    }
cleanup:
    return error_is_clean(err);
}

// All stages, or those up to one that has no solution. Nobody else sees parts of the bulk rest.
static bool solve_stages(Sdirk *scheme, int32_t k, const State *from, State *to,
                         StepOutcome *outcome, Error *err)
{
    bool alone = scheme->symmetric_alone && scheme->part != PART_WHOLE, done = true;
    outcome->solved = true;
    if (alone) symmetric_part_alone(&scheme->half->bulk, true);
    for (int32_t i = 0; i < SDIRK_STAGES && outcome->solved && done; i++)
        done = solve_stage(scheme, k, i, from, to, outcome, err);
    if (alone) symmetric_part_alone(&scheme->half->bulk, false);
    return done;
}

bool sdirk_step(Sdirk *scheme, int32_t k, const State *from, State *to, StepOutcome *outcome,
                Error *err)
{
    *outcome = (StepOutcome){0};
    // The matrices of the contact. That of the antisymmetric part comes before the stages, as it
    // may make the level anew.
    if (!dt_level_operator(scheme->dt_levels, k, scheme->part, err)) goto cleanup;
    bool both = scheme->part != PART_WHOLE && scheme->antisymmetric_acts;
    scheme->antisymmetric = both ? dt_level_contact(scheme->dt_levels, k, PART_ANTISYMMETRIC)
                                 : NULL;
    if (!scheme->dt_levels->half) scheme->part = PART_WHOLE;   // S is not its own mirror image
    if (both && !scheme->antisymmetric && scheme->part != PART_WHOLE) goto cleanup;

    // The contact as it was is the first guess of the stages.
    size_t bytes = (size_t)from->interface_count * sizeof(double);
    memcpy(to->status, from->status, (size_t)from->contact_count);
    memcpy(to->rod_touches, from->rod_touches, (size_t)from->rod_count);
    memcpy(to->slip_rate, from->slip_rate, bytes);
    memcpy(to->reaction, from->reaction, bytes);
    friction_states_begin(&scheme->memory, from);
    TRY(solve_stages(scheme, k, from, to, outcome, err));
    if (!outcome->solved) goto cleanup;

    // Size of the local error of u, as stepping/tableau estimates it, and that of friction's
    // states.
    const BulkOperator *system = scheme->system;
    double step = dt_level_step(scheme->dt_levels, k), *error = scheme->rhs;
    int32_t dofs = system->dof_count;
    for (int32_t d = 0; d < dofs; d++)
        error[d] = step * (SDIRK2.error[0] * from->velocity[d] +
                           SDIRK2.error[SDIRK_STAGES] * to->velocity[d]);
    for (int32_t i = 0; i + 1 < SDIRK_STAGES; i++)
        add_scaled(step * SDIRK2.error[i + 1], scheme->stage_velocity + (int64_t)i * dofs, dofs,
                   error);
    outcome->error = bulk_operator_size(system, error);
    double forgets = friction_states_error(&scheme->memory, step);
    if (forgets > outcome->error) outcome->error = forgets;

    // Now and then the largest |M a + C v + K u + sum_k K_k e_k - f - r|, but for M a all computed
    // for it. K u stays: what the steps add up of it must not drift.
    if (scheme->steps++ % AUDIT_EVERY != 0) goto cleanup;
    double *sum = scheme->viscous, factor = load_factor(scheme->course, to->time);
    bulk_operator_apply(system, BULK_DAMPING, to->velocity, sum);
    bulk_operator_apply(system, BULK_STIFFNESS, to->displacement, to->elastic_force);
    for (int32_t d = 0; d < dofs; d++)
        sum[d] += to->inertia[d] + to->elastic_force[d] - factor * system->load[d];
    branches_add_force(&scheme->branches, to, sum);
    for (int32_t m = 0; m < to->interface_count; m++)
        sum[system->interface_dofs[m]] -= to->reaction[m];
    outcome->residual = dense_max_abs(sum, dofs);
cleanup:
    return error_is_clean(err);
}

void sdirk_add_energy(const Sdirk *scheme, const StepOutcome *outcome, double step,
                      EnergyLedger *ledger)
{
    for (int32_t i = 0; i < SDIRK_STAGES; i++) {
        double weight = step * SDIRK2.a[SDIRK_STAGES - 1][i];
        ledger->rod_work += weight * outcome->power[i].rod;
        ledger->viscous += weight * outcome->power[i].viscous;
        ledger->frictional += weight * outcome->power[i].frictional;
    }
    ledger->load_work += outcome->load_work;
    for (int32_t k = 0; k < scheme->branches.spectrum->count; k++)
        ledger->branch[k].dissipated += outcome->relaxed[k];
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
