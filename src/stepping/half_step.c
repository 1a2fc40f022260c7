// SPDX-License-Identifier: GPL-2.0-or-later
#include "stepping/half_step.h"

#include "algebra/dense.h"
#include "base/clock.h"
#include "base/memory.h"
#include "base/parallel.h"

#include <math.h>
#include <string.h>

// Largest antisymmetric part of a problem over its largest symmetric one: rounding of a state that
// was stepped as a whole, far below what a step may be off.
static const double ALIKE = 1e-9;

// Interface unknowns of one side from which on its parts are certified in two threads: some tenths
// of a millisecond each.
enum { PARALLEL_UNKNOWNS = 300 };

bool half_step_create(const Block *block, const Certificate *whole, HalfStep *half, Error *err)
{
    const Interface *interface = &half->contact.interface;
    int32_t *image = NULL;
    double *sign = NULL;
    *half = (HalfStep){.friction = friction_everywhere(friction_constant(0))};   // none so far
    TRY(contact_half_find(block->interface, &half->contact, err));
    if (interface->contact_count == 0) goto cleanup;

    // The rod. A node that stands for two yields half as much to the sum of their forces.
    Rod *rod = &half->rod;
    rod->softness = NEW_ARRAY(double, interface->rod_count, err);
    rod->lag = NEW_ARRAY(double, interface->rod_count, err);
    TRY(error_is_clean(err));
    bool alike = true;
    for (int32_t j = 0; alike && j < interface->rod_count; j++) {
        int32_t own = half->contact.rod[j], across = half->contact.rod_image[j];
        double softness = block->rod->softness[own], lag = block->rod->lag[own];
        alike = fabs(softness - block->rod->softness[across]) <= ALIKE * softness &&
                fabs(lag - block->rod->lag[across]) <= ALIKE * lag;
        rod->softness[j] = own == across ? softness : 0.5 * softness;
        rod->lag[j] = lag;
    }

    // The symmetric part of the bulk, by the images that the interface has.
    TRY((image = NEW_ARRAY(int32_t, half->contact.both_count, err)));
    TRY((sign = NEW_ARRAY(double, half->contact.both_count, err)));
    for (int32_t k = 0; k < interface->count; k++) {
        int32_t own = half->contact.unknown[k], across = half->contact.image[k];
        image[own] = across;
        image[across] = own;
        sign[own] = sign[across] = half->contact.sign[k];
    }
    TRY(symmetric_part_find(block->system, image, sign, &half->bulk, err));

    // States, solvers and their work.
    TRY(state_create(&(BulkOperator){0}, interface, &half->one_side, err));
    TRY(state_create(block->system, block->interface, &half->symmetrised, err));
    TRY(contact_solver_create(interface, &half->solver, err));
    TRY(contact_newton_create(interface, &half->newton, err));
    half->nodes = NEW_ARRAY(FrictionNode, block->interface->contact_count, err);
    half->g = NEW_ARRAY(double, interface->count, err);
    half->bound = NEW_ARRAY(double, interface->count, err);
    half->anti_g = NEW_ARRAY(double, interface->count, err);
    half->anti_bound = NEW_ARRAY(double, interface->count, err);
    half->anti_velocity = NEW_ARRAY(double, interface->count, err);
    half->anti_reaction = NEW_ARRAY(double, interface->count, err);
    TRY(error_is_clean(err));

    // Certificates of both parts.
    Block one_side = {.interface = interface, .friction = &half->friction, .rod = rod};
    for (ContactPart part = PART_SYMMETRIC; alike && part <= PART_ANTISYMMETRIC; part++) {
        Certificate *certificate = part == PART_SYMMETRIC ? &half->symmetric : &half->antisymmetric;
        TRY(certificate_halve(whole, &half->contact, &one_side, part, certificate, err));
        alike = certificate->damping_contact.schur != NULL;
    }
    half->exists = alike;
cleanup:
    memory_free_all(image, sign);
    return error_is_clean(err);
}

void half_step_destroy(HalfStep *half)
{
    certificate_destroy(&half->symmetric);
    certificate_destroy(&half->antisymmetric);
    contact_solver_destroy(&half->solver);
    contact_half_destroy(&half->contact);
    state_destroy(&half->one_side);
    state_destroy(&half->symmetrised);
    symmetric_part_destroy(&half->bulk);
    memory_free_all(half->rod.softness, half->rod.lag, half->nodes, half->g, half->bound,
                    half->anti_g, half->anti_bound, half->anti_velocity, half->anti_reaction);
    contact_newton_destroy(&half->newton);
    *half = (HalfStep){0};
}

bool half_step_take_friction(HalfStep *half, const Friction *friction)
{
    half->friction = *friction;
    if (!friction->node) return true;
    half->friction.node = half->nodes;
    bool alike = true;
    for (int32_t i = 0; i < half->contact.interface.contact_count; i++) {
        const FrictionNode *across = &friction->node[half->contact.node_image[i]];
        half->nodes[i] = friction->node[half->contact.node[i]];
        alike = alike && memcmp(&half->nodes[i], across, sizeof *across) == 0;
    }
    return alike;
}

// The symmetric part of a solution, on one side.
static void fold_solution(const ContactHalf *half, const ContactSolution *from,
                          const ContactSolution *to)
{
    contact_half_fold(half, false, from->velocity, to->velocity);
    contact_half_fold_forces(half, false, from->reaction, to->reaction);
    contact_half_fold_statuses(half, from->status, from->rod_touches, to);
}

const State *half_step_fold(HalfStep *half, const State *state)
{
    State *one_side = &half->one_side;
    ContactSolution from = {state->slip_rate, state->reaction, state->status, state->rod_touches};
    ContactSolution to = {one_side->slip_rate, one_side->reaction, one_side->status,
                          one_side->rod_touches};
    fold_solution(&half->contact, &from, &to);
    return one_side;
}

// K, C and M join no symmetric motion to an antisymmetric one, so that the energy lost is that of
// what is dropped.
void half_step_symmetrise(HalfStep *half, State *state, double *bound)
{
    const ContactHalf *contact = &half->contact;
    const int32_t *interface_dofs = half->bulk.exists ? half->bulk.system->interface_dofs : NULL;
    State *to = &half->symmetrised;
    if (!interface_dofs) return;
    state_copy(state, to);
    symmetric_part_take(&half->bulk, state->displacement, to->displacement);
    symmetric_part_take(&half->bulk, state->velocity, to->velocity);
    symmetric_part_take(&half->bulk, state->elastic_force, to->elastic_force);
    symmetric_part_take(&half->bulk, state->momentum, to->momentum);
    symmetric_part_take(&half->bulk, state->inertia, to->inertia);
    for (int32_t k = 0; k < state->branch_count; k++) {
        int64_t at = (int64_t)k * state->dof_count;
        symmetric_part_take(&half->bulk, state->stretch + at, to->stretch + at);
        symmetric_part_take(&half->bulk, state->pull + at, to->pull + at);
    }
    // u'K u/2 + v'M v/2 of what would be dropped, and of what stays.
    double dropped = 0, kept = state_elastic_energy(to) +
                               0.5 * dense_dot(to->velocity, to->momentum, to->dof_count);
    for (int32_t k = 0; k < state->dof_count; k++)
        dropped += (state->displacement[k] - to->displacement[k]) *
                       (state->elastic_force[k] - to->elastic_force[k]) +
                   (state->velocity[k] - to->velocity[k]) * (state->momentum[k] - to->momentum[k]);
    if (!(0.5 * dropped <= ALIKE * ALIKE * kept)) return;
    contact_half_symmetrise(contact, to->slip_rate, half->g);
    contact_half_symmetrise(contact, bound, half->g);
    contact_half_symmetrise_forces(contact, to->reaction, half->g);
    for (int32_t k = 0; k < to->interface_count; k++)
        to->velocity[interface_dofs[k]] = to->slip_rate[k];
    state_copy(to, state);
    half->asymmetry = 0;
}

// Forces are looked at, as they say nothing of the way that the block has slid as a whole.
bool half_step_is_symmetric(const HalfStep *half, const State *state, double limit)
{
    const SymmetricPart *bulk = &half->bulk;
    bool symmetric = bulk->exists &&
                     symmetric_part_antisymmetric(bulk, state->elastic_force) <= limit &&
                     symmetric_part_antisymmetric(bulk, state->momentum) <= limit &&
                     symmetric_part_antisymmetric(bulk, bulk->system->load) <= limit;
    for (int32_t k = 0; k < state->branch_count && symmetric; k++) {
        const double *pull = state->pull + (int64_t)k * state->dof_count;
        symmetric = symmetric_part_antisymmetric(bulk, pull) <= limit;
    }
    return symmetric;
}

bool half_step_solve(HalfStep *half, const ContactProblem *problem, ContactMatrix *antisymmetric,
                     ContactSolution *solution, bool *alike)
{
    const ContactHalf *contact = &half->contact;
    State *one_side = &half->one_side;
    int32_t count = contact->interface.count;
    size_t bytes = (size_t)contact->both_count * sizeof(double);

    // The forces and bounds of the problem, folded; how far they are from their own image.
    contact_half_fold_forces(contact, false, problem->g, half->g);
    contact_half_fold_forces(contact, true, problem->g, half->anti_g);
    contact_half_fold(contact, false, problem->bound, half->bound);
    contact_half_fold(contact, true, problem->bound, half->anti_bound);
    double force = dense_max_abs(half->g, count);
    double speed = fmax(force / problem->matrix->diagonal, dense_max_abs(half->bound, count));
    half->asymmetry = fmax(dense_max_abs(half->anti_g, count) / force,
                           dense_max_abs(half->anti_bound, count) / speed);
    *alike = half->asymmetry <= ALIKE;
    if (!*alike) return false;

    // The problem of one side.
    ContactSolution at = {one_side->slip_rate, one_side->reaction, one_side->status,
                          one_side->rod_touches};
    fold_solution(contact, solution, &at);
    ContactProblem folded = *problem;
    folded.interface = &contact->interface;
    folded.friction = &half->friction;
    folded.rod_softness = half->rod.softness;
    folded.rod_lag = half->rod.lag;
    folded.g = half->g;
    folded.bound = half->bound;
    if (!contact_solve(&half->solver, &folded, &at)) return false;
    memset(solution->velocity, 0, bytes);
    memset(solution->reaction, 0, bytes);
    contact_half_add(contact, false, at.velocity, solution->velocity);
    contact_half_add_forces(contact, false, at.reaction, solution->reaction);
    contact_half_unfold_statuses(contact, &at, solution->status, solution->rod_touches);
    if (!antisymmetric) return true;

    // The antisymmetric part, to first order.
    folded.matrix = antisymmetric;
    folded.g = half->anti_g;
    folded.bound = half->anti_bound;
    ContactSolution anti = {half->anti_velocity, half->anti_reaction, at.status, at.rod_touches};
    if (!contact_newton_follow(&half->newton, half->solver.newton.row, &folded, &anti))
        return false;
    contact_half_add(contact, true, anti.velocity, solution->velocity);
    contact_half_add_forces(contact, true, anti.reaction, solution->reaction);
    return true;
}

void half_step_archive(HalfStep *half, Archive *archive)
{
    if (!half->exists) return;
    archive_number(archive, &half->asymmetry);
    contact_solver_archive(&half->solver, &half->contact.interface, archive);
    certificate_archive(&half->symmetric, archive);
    certificate_archive(&half->antisymmetric, archive);
}

// --- certificates of the parts ------------------------------------------------------------------

// A question to both parts, which needs no level but this one.
typedef struct BothParts {
    HalfStep *half;
    const State *one_side;
    ContactMatrix *level[2];   // symmetric, antisymmetric; NULL: whether they hold
    double reach;
    bool yes[2];
} BothParts;

static void ask_part(void *context, int32_t k, int32_t worker)
{
    BothParts *both = context;
    Certificate *certificate = k == 0 ? &both->half->symmetric : &both->half->antisymmetric;
    const State *state = both->one_side;
    (void)worker;
    both->yes[k] = both->level[k]
                       ? certificate_step_resolves(certificate, state, both->level[k], both->reach)
                       : certificate_holds(certificate, state, both->reach);
}

// Side by side where that is worth a thread; `seconds` go by the clock.
static void ask_both(CertifiedParts parts, BothParts *both)
{
    double started = clock_seconds(), before = parts.whole->seconds;
    parallel_where(parts.half->contact.interface.count >= PARALLEL_UNKNOWNS, 2, ask_part, both);
    certificate_take_counts(parts.whole, &parts.half->symmetric);
    certificate_take_counts(parts.whole, &parts.half->antisymmetric);
    parts.whole->seconds = before + clock_seconds() - started;
}

bool parts_hold(CertifiedParts parts, const State *state, double reach, bool *antisymmetric_decays)
{
    HalfStep *half = parts.half;
    *antisymmetric_decays = false;
    if (!parts.halved) return certificate_holds(parts.whole, state, reach);
    BothParts both = {.half = half, .one_side = half_step_fold(half, state), .reach = reach};
    ask_both(parts, &both);
    *antisymmetric_decays = half->antisymmetric_decays = both.yes[1];
    return both.yes[0] && both.yes[1];
}

// The answer of one certificate.
static bool answer(Certificate *certificate, const State *state, DtLevels *dt_levels,
                   PartsAsked asked, LevelRange range, double growth)
{
    int32_t k = range.first;
    switch (asked) {
    case PARTS_RESOLVE: {
        ContactMatrix *level = dt_level_contact(dt_levels, k, certificate->part);
        return level &&
               certificate_step_resolves(certificate, state, level, dt_level_reach(dt_levels, k));
    }
    case PARTS_FIND_NO_RUNAWAY:
        return !certificate_finds_runaway(certificate, state, dt_levels, k);
    case PARTS_OSCILLATE_LESS:
        return certificate_oscillates_less(certificate, state, dt_levels, range, growth);
    case PARTS_EXCLUDE_RUNAWAY:
        return certificate_excludes_runaway(certificate, state, dt_levels, range);
    }
    return false;
}

bool parts_ask(CertifiedParts parts, const State *state, PartsAsked asked, LevelRange range,
               double growth)
{
    HalfStep *half = parts.half;
    DtLevels *dt_levels = parts.dt_levels;
    if (!parts.halved) return answer(parts.whole, state, dt_levels, asked, range, growth);
    const State *one_side = half_step_fold(half, state);
    if (asked == PARTS_RESOLVE && !half->antisymmetric_decays) {
        int32_t k = range.first;
        BothParts both = {.half = half,
                          .one_side = one_side,
                          .level = {dt_level_contact(dt_levels, k, PART_SYMMETRIC),
                                    dt_level_contact(dt_levels, k, PART_ANTISYMMETRIC)},
                          .reach = dt_level_reach(dt_levels, k)};
        if (!both.level[0] || !both.level[1] || !dt_levels->half) return false;
        ask_both(parts, &both);
        return both.yes[0] && both.yes[1];
    }
    bool yes = answer(&half->symmetric, one_side, dt_levels, asked, range, growth);
    if (yes && !half->antisymmetric_decays)
        yes = answer(&half->antisymmetric, one_side, dt_levels, asked, range, growth);
    certificate_take_counts(parts.whole, &half->symmetric);
    certificate_take_counts(parts.whole, &half->antisymmetric);
    return yes && dt_levels->half;   // else a level was found that is not its own mirror image
}
