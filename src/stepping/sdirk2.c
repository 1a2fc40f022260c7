// SPDX-License-Identifier: GPL-2.0-or-later
#include "stepping/sdirk2.h"

#include "base/dense.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

bool sdirk2_create(const Block *block, Ladder *ladder, Sdirk2 *scheme, Error *err)
{
    const BulkOperator *system = block->system;
    const Interface *interface = block->interface;
    *scheme = (Sdirk2){.system = block->system,
                       .interface = interface,
                       .law = block->law,
                       .rod = block->rod,
                       .ladder = ladder};
    scheme->rhs = NEW_ARRAY(double, system->dof_count, err);
    scheme->force = NEW_ARRAY(double, system->dof_count, err);
    scheme->viscous = NEW_ARRAY(double, system->dof_count, err);
    scheme->v1 = NEW_ARRAY(double, system->dof_count, err);
    scheme->predictor = NEW_ARRAY(double, system->dof_count, err);
    scheme->g = NEW_ARRAY(double, interface->count, err);
    scheme->bound = NEW_ARRAY(double, interface->count, err);
    scheme->stage_velocity = NEW_ARRAY(double, interface->count, err);
    scheme->stage_reaction = NEW_ARRAY(double, interface->count, err);
    if (!error_is_clean(err)) return false;
    return contact_solver_create(interface, contact_solver_def(), &scheme->solver, err);
}

void sdirk2_destroy(Sdirk2 *scheme)
{
    contact_solver_destroy(&scheme->solver);
    memory_free(scheme->rhs);
    memory_free(scheme->force);
    memory_free(scheme->viscous);
    memory_free(scheme->v1);
    memory_free(scheme->predictor);
    memory_free(scheme->g);
    memory_free(scheme->bound);
    memory_free(scheme->stage_velocity);
    memory_free(scheme->stage_reaction);
    *scheme = (Sdirk2){0};
}

// Every so many steps the end state is put into the full equation, every term computed anew.
enum { AUDIT_EVERY = 32 };

// bound = (position to reach at `time` - u*) / (gamma dt): the plane for normals, the rod for rods.
static void fill_bounds(Sdirk2 *scheme, const double *predictor, double time, double scaled_step)
{
    const Interface *interface = scheme->interface;
    const int32_t *dofs = scheme->system->interface_dofs;
    scheme->reach = scaled_step;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        int32_t n = interface_normal(i);
        scheme->bound[n] = -predictor[dofs[n]] / scaled_step;
    }
    for (int32_t j = 0; j < interface->rod_count; j++) {
        int32_t x = interface_rod(interface, j);
        scheme->bound[x] = rod_bound(scheme->rod, j, predictor[dofs[x]], time, scaled_step);
    }
}

// Solves A v = rhs + r with the interface's conditions. *solved says whether contact was settled.
static bool solve_stage(Sdirk2 *scheme, InterfaceOperator *rung, ContactSolution *contact,
                        double *v, bool *solved, Error *err)
{
    const Interface *interface = scheme->interface;
    TRY(interface_operator_condense(rung, scheme->rhs, scheme->g, err));
    ContactProblem problem = {.interface = interface,
                              .law = scheme->law,
                              .rod_kind = scheme->rod->kind,
                              .rod_softness = scheme->rod->softness,
                              .rod_reach = scheme->reach + scheme->rod->lag,
                              .schur = interface_operator_schur(rung),
                              .g = scheme->g,
                              .bound = scheme->bound};
    *solved = contact_solve(&scheme->solver, &problem, contact);
    if (!*solved) goto cleanup;
    TRY(interface_operator_expand(rung, contact->velocity, v, err));
    // What is held is held exactly, not to the rounding of the substitution.
    for (int32_t k = 0; k < interface->count; k++)
        v[scheme->system->interface_dofs[k]] = contact->velocity[k];
cleanup:
    return error_is_clean(err);
}

// Local error of u: the scheme's quadrature against the one that is exact for v quadratic in time,
// through v_n, v_1 and v_2, at 0, gamma and 1:   w_1 = 1/(6 gamma (1 - gamma)), w_2 = 1/2 - gamma
// w_1.
static double estimate_error(Sdirk2 *scheme, const double *v0, const double *v2, double step)
{
    double gamma = SDIRK2_GAMMA;
    double w1 = 1 / (6 * gamma * (1 - gamma)), w2 = 0.5 - gamma * w1, w0 = 1 - w1 - w2;
    double e1 = w1 - (1 - gamma), e2 = w2 - gamma;
    const double *v1 = scheme->v1;
    double *error = scheme->rhs;
    for (int32_t k = 0; k < scheme->system->dof_count; k++)
        error[k] = step * (w0 * v0[k] + e1 * v1[k] + e2 * v2[k]);
    return bulk_operator_size(scheme->system, error);
}

// scheme->viscous = C v of a stage that was solved, from its own equation: rhs + r - M v/(gamma dt)
// - gamma dt K v. With M v at hand this costs one K v, which a reduced bulk has almost for nothing.
static void find_viscous(Sdirk2 *scheme, const double *v, const double *momentum,
                         const ContactSolution *contact, double scaled)
{
    const BulkOperator *system = scheme->system;
    double *viscous = scheme->viscous;
    bulk_operator_apply(system, BULK_STIFFNESS, v, viscous);
    for (int32_t i = 0; i < system->dof_count; i++)
        viscous[i] = scheme->rhs[i] - momentum[i] / scaled - scaled * viscous[i];
    for (int32_t k = 0; k < system->interface_count; k++)
        viscous[system->interface_dofs[k]] += contact->reaction[k];
}

// Largest |M a + C v + K u - f - r|, C v computed for it.
static double end_residual(const Sdirk2 *scheme, const State *to)
{
    const BulkOperator *system = scheme->system;
    double *viscous = scheme->viscous;
    bulk_operator_apply(system, BULK_DAMPING, to->velocity, viscous);
    for (int32_t k = 0; k < to->dof_count; k++)
        viscous[k] += to->inertia[k] + to->elastic_force[k] - system->load[k];
    for (int32_t k = 0; k < to->interface_count; k++)
        viscous[system->interface_dofs[k]] -= to->reaction[k];
    return dense_max_abs(viscous, to->dof_count);
}

// The contact as it was, a first guess for a stage that writes into the arrays of `contact`.
static void guess_contact(const State *from, const ContactSolution *contact)
{
    size_t bytes = (size_t)from->interface_count * sizeof(double);
    memcpy(contact->status, from->status, (size_t)from->contact_count);
    memcpy(contact->rod_touches, from->rod_touches, (size_t)from->rod_count);
    memcpy(contact->velocity, from->slip_rate, bytes);
    memcpy(contact->reaction, from->reaction, bytes);
}

// A rung of the ladder: its step and its matrix.
typedef struct Rung {
    double step;
    InterfaceOperator *condensed;
} Rung;

// Stage 1: v_1 from u_n, v_n; leaves M w_2, the momentum stage 2 starts from, in to->inertia.
static bool first_stage(Sdirk2 *scheme, Rung at, const State *from, State *to, StepOutcome *outcome,
                        Error *err)
{
    BulkOperator *system = scheme->system;
    double scaled = SDIRK2_GAMMA * at.step, weight = (1 - SDIRK2_GAMMA) / SDIRK2_GAMMA;
    ContactSolution contact = {.velocity = scheme->stage_velocity,
                               .reaction = scheme->stage_reaction,
                               .status = to->status,
                               .rod_touches = to->rod_touches};
    guess_contact(from, &contact);
    for (int32_t i = 0; i < system->dof_count; i++)
        scheme->rhs[i] = from->momentum[i] / scaled + system->load[i] - from->elastic_force[i];
    fill_bounds(scheme, from->displacement, from->time + scaled, scaled);
    TRY(solve_stage(scheme, at.condensed, &contact, scheme->v1, &outcome->solved, err));
    if (!outcome->solved) goto cleanup;
    bulk_operator_apply(system, BULK_MASS, scheme->v1, scheme->force);
    find_viscous(scheme, scheme->v1, scheme->force, &contact, scaled);
    outcome->power[0] =
        energy_stage(scheme->interface, scheme->v1, scheme->viscous, system->dof_count, &contact);
    for (int32_t i = 0; i < system->dof_count; i++)
        to->inertia[i] = from->momentum[i] + weight * (scheme->force[i] - from->momentum[i]);
    memcpy(to->slip_rate, contact.velocity, (size_t)from->interface_count * sizeof(double));
    memcpy(to->reaction, contact.reaction, (size_t)from->interface_count * sizeof(double));
cleanup:
    return error_is_clean(err);
}

// Stage 2: v_2, which is the end of the step, and everything the state holds.
static bool second_stage(Sdirk2 *scheme, Rung at, const State *from, State *to,
                         StepOutcome *outcome, Error *err)
{
    BulkOperator *system = scheme->system;
    int32_t dofs = system->dof_count;
    double scaled = SDIRK2_GAMMA * at.step, rest = (1 - SDIRK2_GAMMA) * at.step;
    double *predictor = scheme->predictor;
    ContactSolution contact = {.velocity = to->slip_rate,
                               .reaction = to->reaction,
                               .status = to->status,
                               .rod_touches = to->rod_touches};
    for (int32_t i = 0; i < dofs; i++) predictor[i] = from->displacement[i] + rest * scheme->v1[i];
    bulk_operator_apply(system, BULK_STIFFNESS, predictor, scheme->force);
    for (int32_t i = 0; i < dofs; i++)
        scheme->rhs[i] = to->inertia[i] / scaled + system->load[i] - scheme->force[i];
    fill_bounds(scheme, predictor, from->time + at.step, scaled);
    TRY(solve_stage(scheme, at.condensed, &contact, to->velocity, &outcome->solved, err));
    if (!outcome->solved) goto cleanup;

    to->time = from->time + at.step;
    bulk_operator_apply(system, BULK_MASS, to->velocity, to->momentum);
    find_viscous(scheme, to->velocity, to->momentum, &contact, scaled);
    outcome->power[1] =
        energy_stage(scheme->interface, to->velocity, scheme->viscous, dofs, &contact);
    for (int32_t i = 0; i < dofs; i++) {
        to->displacement[i] = predictor[i] + scaled * to->velocity[i];
        to->inertia[i] = (to->momentum[i] - to->inertia[i]) / scaled;
        outcome->load_work += system->load[i] * (to->displacement[i] - from->displacement[i]);
    }
    bulk_operator_apply(system, BULK_STIFFNESS, to->displacement, to->elastic_force);
cleanup:
    return error_is_clean(err);
}

bool sdirk2_step(Sdirk2 *scheme, int32_t k, const State *from, State *to, StepOutcome *outcome,
                 Error *err)
{
    double step = ladder_step(scheme->ladder, k);
    *outcome = (StepOutcome){0};
    Rung at = {.step = step, .condensed = ladder_rung(scheme->ladder, k, err)};
    if (!at.condensed) goto cleanup;
    TRY(first_stage(scheme, at, from, to, outcome, err));
    if (!outcome->solved) goto cleanup;
    TRY(second_stage(scheme, at, from, to, outcome, err));
    if (!outcome->solved) goto cleanup;
    outcome->error = estimate_error(scheme, from->velocity, to->velocity, step);
    bool audited = scheme->steps++ % AUDIT_EVERY == 0;
    outcome->residual = audited ? end_residual(scheme, to) : 0;
cleanup:
    return error_is_clean(err);
}

void sdirk2_add_energy(const StepOutcome *outcome, double step, EnergyLedger *ledger)
{
    double weight[2] = {(1 - SDIRK2_GAMMA) * step, SDIRK2_GAMMA * step};
    for (int j = 0; j < 2; j++) {
        ledger->rod_work += weight[j] * outcome->power[j].rod;
        ledger->viscous += weight[j] * outcome->power[j].viscous;
        ledger->frictional += weight[j] * outcome->power[j].frictional;
    }
    ledger->load_work += outcome->load_work;
}
