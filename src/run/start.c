// SPDX-License-Identifier: GPL-2.0-or-later
// Lengths here are the block's; slip is measured by what the drop of friction can drive
// (model_friction_slip), where branches have not relaxed yet.
#include "run/simulation_state.h"

#include "base/clock.h"
#include "base/memory.h"
#include "friction/friction.h"
#include "model/step_rule.h"
#include "scene/programs.h"
#include "stepping/step_control.h"
#include "stepping/stable_step.h"

#include <math.h>

// Local error of u in one step, relative to the slip that the drop of friction can drive,
// (mu_S - mu_K) p H / E. On 40 cells, set A, they cost 560, 630, 880 steps and move the slip map up
// to the first sliding by 5e-3, 2.5e-3, 1e-4, less than the mesh does; mu_M by 1e-3 at most, which
// is the scatter between cycles (validation/benchmark).
static const double TOLERANCES[] = {
    [ACCURACY_DRAFT] = 2e-2, [ACCURACY_STANDARD] = 5e-3, [ACCURACY_FINE] = 5e-4};

// Recording intervals of an explicit run, beside those of rapid slip.
static const double EXPLICIT_RECORDS = 2000;

static const RodKind ROD_KINDS[] = {
    [ROD_PUSH] = ROD_PUSHES, [ROD_BONDED] = ROD_IS_BONDED, [ROD_NONE] = ROD_AWAY};

// While relaxing the rod is away, or held where start.rod says so.
bool start_prepare_steps(Simulation *simulation, Error *err)
{
    const Scene *scene = &simulation->scene;
    Model *model = &simulation->model;
    const FrictionLaw *law = model->friction.whole.law;
    StepSizes sizes = {.slip = model_friction_slip(model) / model_stiffening(model),
                       .yield = model_machine_yield(model),
                       .memory = law->remembers ? law->slip_distance : 0,
                       .crossing = model_crossing(model),
                       .tolerance = TOLERANCES[scene->time.accuracy]};
    StepControlDef def = step_rule(scene, &sizes);
    def.relax_step = model_settling_time(model);
    def.slip_per_mu = model_slip_per_mu(model) / model_stiffening(model);
    simulation->t_end = step_rule_end(scene);
    bool held = scene->start.rod == START_ROD_HELD;
    RodKind kind = held ? ROD_KINDS[scene->rod.kind] : ROD_AWAY;
    simulation->friction = model->friction;
    if (!model_build_rod(model, kind, &simulation->rod, err)) return false;
    Block block = {.system = &model->system,
                   .interface = &model->interface,
                   .friction = &simulation->friction,
                   .rod = &simulation->rod,
                   .stage_friction = model->friction_nodes};
    return step_control_create(&block, &def, &simulation->control, err);
}

void start_programs(Simulation *simulation)
{
    const Scene *scene = &simulation->scene;
    simulation->rod_course = scene_rod_course(scene);
    simulation->load_course = (LoadCourse){.schedule = scene_schedule(&scene->load.program),
                                           .by_way = scene->load.program.U.count > 0,
                                           .rod = &simulation->rod};
    if (scene_has_program(&scene->rod.program)) simulation->rod.course = &simulation->rod_course;
    if (scene_has_program(&scene->load.program))
        simulation->control.scheme.course = &simulation->load_course;
}

// RelaxationDef asks this now and then.
static bool may_go_on(const void *self, Error *err)
{
    return simulation_may_go_on(self, err);
}

// An undeformed start skips relaxing. At the end t = 0, the ledger is opened, the model's friction
// acts and the rod has its velocity.
bool start_relax(Simulation *simulation, Error *err)
{
    const Scene *scene = &simulation->scene;
    const Model *model = &simulation->model;
    int32_t contacts = model->interface.contact_count;
    FrictionNode *constant = NULL;
    double started = clock_seconds();
    RelaxationDef def = {.speed_max = scene->start.tolerance * model->scales.slip_velocity,
                         .duration_max = scene->start.duration_max * model_settling_time(model),
                         .may_go_on = may_go_on,
                         .self = simulation};
    if (scene->start.friction == START_FRICTION_OFF)
        simulation->friction = friction_everywhere(friction_constant(0));
    else if (friction_creeps(&model->friction, contacts)) {
        // No block ever settles on what never sticks: there mu is that at the reference velocity.
        TRY((constant = NEW_ARRAY(FrictionNode, contacts, err)));
        for (int32_t i = 0; i < contacts; i++) {
            constant[i] = *friction_at(&model->friction, i);
            const FrictionLaw *law = constant[i].law;
            if (law->creeps)
                constant[i] = friction_constant(constant[i].factor * law->mu_reference);
        }
        simulation->friction = friction_of_nodes(constant, contacts);
    }
    if (scene->start.state == START_RELAXED)
        relax(&simulation->control, &def, &simulation->relaxation_steps, err);
    simulation->friction = model->friction;
    memory_free(constant);
    if (!error_is_clean(err)) goto cleanup;
    simulation->rod.kind = ROD_KINDS[scene->rod.kind];
    simulation->rod.velocity = scene->rod.velocity;
    start_programs(simulation);

    // The rod comes to the face where that is now. One that was held stands where it stood, however
    // far its soft ends were pressed in.
    const Interface *interface = &model->interface;
    const BulkOperator *system = &model->system;
    State *now = &simulation->control.now;
    bool held = scene->start.rod == START_ROD_HELD;
    if (scene->rod.kind != ROD_NONE && !held) {
        now->rod_way = 0;
        for (int32_t j = 0; j < interface->rod_count; j++)
            simulation->rod.origin[j] =
                now->displacement[system->interface_dofs[interface_rod(interface, j)]];
    }

    // The velocity at t = 0 is added, but for what is held. (What may move in a reduced bulk never
    // is.)
    if (scene->start.velocity_x != 0 || scene->start.velocity_z != 0) {
        const uint8_t *fixed = system->reduced ? NULL : model->bulk.held;
        const double *x = system->rigid, *z = x + (int64_t)(interface->dim - 1) * now->dof_count;
        for (int32_t k = 0; k < now->dof_count; k++) {
            if (fixed && fixed[k]) continue;
            now->velocity[k] += scene->start.velocity_x * x[k];
            now->velocity[k] += scene->start.velocity_z * z[k];
        }
        for (int32_t k = 0; k < interface->count; k++)
            now->slip_rate[k] = now->velocity[system->interface_dofs[k]];
        bulk_operator_apply(system, BULK_MASS, now->velocity, now->momentum);
    }
    friction_states_reset(&simulation->control.scheme.memory, &simulation->control.now);
    step_control_restart(&simulation->control);
cleanup:
    simulation->timing.relax = clock_seconds() - started;
    return error_is_clean(err);
}

bool start_explicit_steps(Simulation *simulation, Error *err)
{
    const Scene *scene = &simulation->scene;
    StepControl *control = &simulation->control;
    double step = 0, interval = simulation->t_end / EXPLICIT_RECORDS;
    if (scene->time.scheme != SCHEME_EXPLICIT) return true;
    const Model *model = &simulation->model;
    const Bulk *bulk = model->mesh.is_base ? &model->bulk_of_nodes : &model->bulk;
    if (!stable_step(bulk, &step, err)) return false;
    if (scene->time.step_max > 0) step = fmin(step, scene->time.step_max);
    double steps = ceil(interval / step);
    if (steps < 1 || steps > 1e15)
        return FAULT(err, ERROR_COMPUTE, "explicit steps of %g in %g of time cannot be counted",
                     step, interval);
    simulation->explicit_steps = (int64_t)steps;
    ExplicitDef def = {.bulk = bulk,
                       .mesh = &model->mesh,
                       .interface = &model->interface,
                       .friction = &simulation->friction,
                       .rod = &simulation->rod,
                       .course = control->scheme.course,
                       .step = interval / steps,
                       .stage_friction = control->scheme.memory.node};
    if (!explicit_reference_create(&def, &simulation->explicit_reference, err)) return false;
    explicit_reference_start(&simulation->explicit_reference, &control->now);
    step_control_use_explicit(control, &simulation->explicit_reference);
    return true;
}
