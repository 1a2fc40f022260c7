// SPDX-License-Identifier: GPL-2.0-or-later
// What a run steps with, from a shape that stands (model/model_shape): tolerances and steps, the
// rod, and the start. Lengths here are the block's; slip is measured by what the drop of friction
// can drive, so that tolerances hold for any load and any units.
#include "model/model.h"

#include "base/clock.h"
#include "model/step_rule.h"
#include "stepping/relaxation.h"

#include <math.h>

// Local error of u in one step, relative to the slip that the drop of friction can drive,
// (mu_S - mu_K) p H / E. On 40 cells, set A, they cost 560, 630, 880 steps and move the slip map up
// to the first sliding by 5e-3, 2.5e-3, 1e-4, less than the mesh does; mu_M by 1e-3 at most, which
// is the scatter between cycles (validation/benchmark).
static const double TOLERANCES[] = {
    [ACCURACY_DRAFT] = 2e-2, [ACCURACY_STANDARD] = 5e-3, [ACCURACY_FINE] = 5e-4};

// The slip that the drop of friction drives: (mu_S - mu_K) p H / E, with p the mean pressure.
// Length. For Coulomb friction, which has no drop, mu_S stands in its place; without any friction
// 1.
static double friction_slip(const Simulation *simulation)
{
    const FrictionLaw *law = &simulation->law;
    double drop = law->kind == FRICTION_COULOMB ? law->mu_static : law->mu_static - law->mu_kinetic;
    if (drop <= 0) drop = law->mu_static > 0 ? law->mu_static : 1;
    double pressure = simulation->scales.load / simulation->model.length;
    return drop * pressure * simulation->model.height / simulation->material.young;
}

// 4 mu (lambda + mu)/(lambda + 2 mu) of sigma = D eps: what a half-plane sets against a pressure.
static double half_plane(double d[3][3])
{
    return d[0][0] > 0 ? 4 * d[2][2] * (d[0][0] - d[2][2]) / d[0][0] : 0;
}

// At rest, its origin not yet set: touch_rod does that when the block has relaxed. Soft ends get E*
// of the elastic and of the viscous stiffness (contact/rod).
bool model_build_rod(Simulation *simulation, RodKind kind, Error *err)
{
    const Material *material = &simulation->material;
    double elastic[3][3], viscous[3][3];
    material_elastic(material, elastic);
    material_viscous(material, viscous);
    if (!rod_build(&simulation->interface, kind, 0, &simulation->rod, err)) return false;
    rod_soften(&simulation->interface, half_plane(elastic), half_plane(viscous), &simulation->rod);
    return true;
}

// simulation->system, interface, law and material stand. While relaxing the rod is away, or held
// where start.rod says so.
bool model_prepare_steps(Simulation *simulation, Error *err)
{
    const Scene *scene = &simulation->scene;
    StepSizes sizes = {.slip = friction_slip(simulation),
                       .crossing = simulation->model.length /
                                   material_slip_speed(&simulation->material),
                       .tolerance = TOLERANCES[scene->time.accuracy]};
    StepControlDef def = step_rule(scene, &sizes);
    def.relax_step = simulation->scales.time;
    simulation->t_end = step_rule_end(scene);
    RodKind kind = scene->start.rod == START_ROD_HELD && scene->rod.kind != ROD_NONE
                       ? (scene->rod.kind == ROD_PUSH ? ROD_PUSHES : ROD_IS_BONDED)
                       : ROD_AWAY;
    TRY(model_build_rod(simulation, kind, err));
    Block block = {.system = &simulation->system,
                   .interface = &simulation->interface,
                   .law = &simulation->law,
                   .rod = &simulation->rod};
    TRY(step_control_create(&block, &def, &simulation->control, err));
cleanup:
    return error_is_clean(err);
}

// The rod comes to the face where that is now.
static void touch_rod(Simulation *simulation)
{
    const Interface *interface = &simulation->interface;
    const State *now = &simulation->control.now;
    for (int32_t j = 0; j < interface->rod_count; j++)
        simulation->rod.origin[j] =
            now->displacement[simulation->system.interface_dofs[interface_rod(interface, j)]];
}

// Adds the velocity at t = 0, but for what is held. A reduced bulk's first unknowns are the
// interface's, and their static modes move all of it.
static void set_moving(Simulation *simulation)
{
    const Interface *interface = &simulation->interface;
    const BulkOperator *system = &simulation->system;
    State *state = &simulation->control.now;
    double velocity[2] = {simulation->scene.start.velocity_x, simulation->scene.start.velocity_z};
    int32_t moved = system->reduced ? interface->count : state->dof_count;
    for (int32_t k = 0; k < moved; k++) {
        int32_t dof = system->reduced ? interface->dofs[k] : k;
        if (!simulation->bulk.held[dof]) state->velocity[k] += velocity[dof % 2];
    }
    for (int32_t k = 0; k < interface->count; k++)
        state->slip_rate[k] = state->velocity[system->interface_dofs[k]];
    bulk_operator_apply(system, BULK_MASS, state->velocity, state->momentum);
}

// The law is replaced while relaxing without friction and comes back whatever happens; an
// undeformed start skips relaxing. At the end t = 0, the ledger is opened and the rod has its
// velocity.
bool model_relax(Simulation *simulation, Error *err)
{
    const Scene *scene = &simulation->scene;
    double started = clock_seconds();
    FrictionLaw law = simulation->law;
    if (scene->start.friction == START_FRICTION_OFF)
        simulation->law = (FrictionLaw){.kind = FRICTION_COULOMB, .mu_static = 0};
    RelaxationDef def = {.speed_max = scene->start.tolerance * simulation->scales.slip_velocity,
                         .duration_max = scene->start.duration_max * simulation->scales.time};
    if (scene->start.state == START_RELAXED)
        TRY(relax(&simulation->control, &def, &simulation->model.relaxation_steps, err));
    simulation->law = law;
    simulation->rod.velocity = scene->rod.velocity;
    if (scene->rod.kind == ROD_NONE) {
        simulation->rod.kind = ROD_AWAY;
    } else {
        simulation->rod.kind = scene->rod.kind == ROD_PUSH ? ROD_PUSHES : ROD_IS_BONDED;
        touch_rod(simulation);
    }
    if (scene->start.velocity_x != 0 || scene->start.velocity_z != 0) set_moving(simulation);
    step_control_restart(&simulation->control);
cleanup:
    simulation->timing.relax = clock_seconds() - started;
    return error_is_clean(err);
}
