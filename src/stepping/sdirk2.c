// SPDX-License-Identifier: GPL-2.0-or-later
#include "stepping/sdirk2.h"

#include "base/dense.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

bool sdirk2_create(BulkOperator *system, const Interface *interface, const FrictionLaw *law,
                   Rod *rod, Sdirk2 *scheme, Error *err)
{
    *scheme = (Sdirk2){.system = system, .interface = interface, .law = law, .rod = rod};
    scheme->rhs = NEW_ARRAY(double, system->dof_count, err);
    scheme->force = NEW_ARRAY(double, system->dof_count, err);
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
    memory_free(scheme->v1);
    memory_free(scheme->predictor);
    memory_free(scheme->g);
    memory_free(scheme->bound);
    memory_free(scheme->stage_velocity);
    memory_free(scheme->stage_reaction);
    *scheme = (Sdirk2){0};
}

// bound = (position to reach at `time` - u*) / (gamma dt): the plane for normals, the rod for rods.
static void fill_bounds(Sdirk2 *scheme, const double *predictor, double time, double scaled_step)
{
    const Interface *interface = scheme->interface;
    for (int32_t i = 0; i < interface->contact_count; i++) {
        int32_t n = interface_normal(i);
        scheme->bound[n] = -predictor[interface->dofs[n]] / scaled_step;
    }
    for (int32_t j = 0; j < interface->rod_count; j++) {
        int32_t x = interface_rod(interface, j);
        double target = scheme->rod->origin[j] + scheme->rod->velocity * time;
        scheme->bound[x] = (target - predictor[interface->dofs[x]]) / scaled_step;
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
                              .schur = interface_operator_schur(rung),
                              .g = scheme->g,
                              .bound = scheme->bound};
    *solved = contact_solve(&scheme->solver, &problem, contact);
    if (!*solved) goto cleanup;
    TRY(interface_operator_expand(rung, contact->velocity, v, err));
    // What is held is held exactly, not to the rounding of the substitution.
    for (int32_t k = 0; k < interface->count; k++) v[interface->dofs[k]] = contact->velocity[k];
cleanup:
    return error_is_clean(err);
}

// Local error of u: the scheme's quadrature against the one that is exact for v quadratic in time,
// through v_n, v_1 and v_2, at 0, gamma and 1:
//     w_1 = 1/(6 gamma (1 - gamma)),   w_2 = 1/2 - gamma w_1.
static double estimate_error(const double *v0, const double *v1, const double *v2, int32_t count,
                             double step)
{
    double gamma = SDIRK2_GAMMA;
    double w1 = 1 / (6 * gamma * (1 - gamma)), w2 = 0.5 - gamma * w1, w0 = 1 - w1 - w2;
    double e1 = w1 - (1 - gamma), e2 = w2 - gamma;
    double largest = 0;
    for (int32_t k = 0; k < count; k++)
        largest = fmax(largest, fabs(w0 * v0[k] + e1 * v1[k] + e2 * v2[k]));
    return step * largest;
}

// Largest |M a + C v + K u - f - r|; viscous: C v at the end.
static double end_residual(const Sdirk2 *scheme, const State *to, double *viscous)
{
    const Bulk *bulk = scheme->system->bulk;
    for (int32_t k = 0; k < to->dof_count; k++)
        viscous[k] += bulk->mass[k] * to->acceleration[k] + to->elastic_force[k] - bulk->load[k];
    for (int32_t k = 0; k < to->interface_count; k++)
        viscous[scheme->interface->dofs[k]] -= to->reaction[k];
    return dense_max_abs(viscous, to->dof_count);
}

bool sdirk2_step(Sdirk2 *scheme, Ladder *ladder, int32_t k, const State *from, State *to,
                 StepOutcome *outcome, Error *err)
{
    BulkOperator *system = scheme->system;
    const Bulk *bulk = system->bulk;
    int32_t dofs = system->dof_count;
    double step = ladder_step(ladder, k), scaled = SDIRK2_GAMMA * step;
    double rest = (1 - SDIRK2_GAMMA) * step;
    double *rhs = scheme->rhs, *v1 = scheme->v1, *predictor = scheme->predictor;
    *outcome = (StepOutcome){0};
    InterfaceOperator *rung = ladder_rung(ladder, k, err);
    if (!rung) goto cleanup;

    memcpy(to->status, from->status, (size_t)from->contact_count);
    memcpy(to->rod_touches, from->rod_touches, (size_t)from->rod_count);
    memcpy(scheme->stage_velocity, from->slip_rate, (size_t)from->interface_count * sizeof(double));
    memcpy(scheme->stage_reaction, from->reaction, (size_t)from->interface_count * sizeof(double));
    ContactSolution stage1 = {.velocity = scheme->stage_velocity,
                              .reaction = scheme->stage_reaction,
                              .status = to->status,
                              .rod_touches = to->rod_touches};
    for (int32_t i = 0; i < dofs; i++)
        rhs[i] = bulk->mass[i] * from->velocity[i] / scaled + bulk->load[i] -
                 from->elastic_force[i];
    fill_bounds(scheme, from->displacement, from->time + scaled, scaled);
    TRY(solve_stage(scheme, rung, &stage1, v1, &outcome->solved, err));
    if (!outcome->solved) goto cleanup;
    bulk_operator_apply(system, BULK_DAMPING, v1, scheme->force);
    outcome->power[0] = energy_stage(scheme->interface, v1, scheme->force, dofs, &stage1);

    memcpy(to->slip_rate, stage1.velocity, (size_t)from->interface_count * sizeof(double));
    memcpy(to->reaction, stage1.reaction, (size_t)from->interface_count * sizeof(double));
    ContactSolution stage2 = {.velocity = to->slip_rate,
                              .reaction = to->reaction,
                              .status = to->status,
                              .rod_touches = to->rod_touches};
    for (int32_t i = 0; i < dofs; i++) predictor[i] = from->displacement[i] + rest * v1[i];
    bulk_operator_apply(system, BULK_STIFFNESS, predictor, scheme->force);
    for (int32_t i = 0; i < dofs; i++) {
        double drift = from->velocity[i] + rest * (v1[i] - from->velocity[i]) / scaled;
        to->acceleration[i] = drift;
        rhs[i] = bulk->mass[i] * drift / scaled + bulk->load[i] - scheme->force[i];
    }
    fill_bounds(scheme, predictor, from->time + step, scaled);
    TRY(solve_stage(scheme, rung, &stage2, to->velocity, &outcome->solved, err));
    if (!outcome->solved) goto cleanup;

    to->time = from->time + step;
    for (int32_t i = 0; i < dofs; i++) {
        to->displacement[i] = predictor[i] + scaled * to->velocity[i];
        to->acceleration[i] = (to->velocity[i] - to->acceleration[i]) / scaled;
        outcome->load_work += bulk->load[i] * (to->displacement[i] - from->displacement[i]);
    }
    bulk_operator_apply(system, BULK_STIFFNESS, to->displacement, to->elastic_force);
    bulk_operator_apply(system, BULK_DAMPING, to->velocity, scheme->force);
    outcome->power[1] = energy_stage(scheme->interface, to->velocity, scheme->force, dofs, &stage2);
    outcome->error = estimate_error(from->velocity, v1, to->velocity, dofs, step);
    outcome->residual = end_residual(scheme, to, scheme->force);
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
