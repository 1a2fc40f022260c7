// SPDX-License-Identifier: GPL-2.0-or-later
#include "run/model.h"

#include "base/clock.h"
#include "base/dense.h"
#include "base/memory.h"
#include "stepping/relaxation.h"

#include <math.h>

// Local error of u in one step, relative to the slip that the drop of friction can drive,
// (mu_S - mu_K) p H / E. Set A, 40x40: 1e-2 moves mu_M by 2e-4 of itself, 1e-3 by 1e-4.
static const double TOLERANCES[] = {
    [ACCURACY_DRAFT] = 1e-2, [ACCURACY_STANDARD] = 1e-3, [ACCURACY_FINE] = 1e-4};

static const double STEP_MAX_SLIP = 0.2;   // rung 0: the rod moves this part of that slip
static const double STEPS_AT_LEAST = 50;   // and a run has at least so many
static const double STEP_RANGE = 1e-10;   // step_min over step_max
static const double ROD_HEIGHT = 0.5, ROD_WIDTH = 0.1;   // of H

bool model_read_mesh(Simulation *simulation, Error *err)
{
    const Scene *scene = &simulation->scene;
    double started = clock_seconds();
    MeshFile file = {0};
    TRY(mesh_file_read(scene->mesh.file, scene->mesh.parameters, scene->mesh.parameter_count, &file,
                       err));
    TRY(mesh_build(&file, scene->mesh.file, &simulation->mesh, err));
    const Mesh *mesh = &simulation->mesh;
    simulation->model.length = mesh->x_max - mesh->x_min;
    simulation->model.height = mesh->z_max - mesh->z_min;
    simulation->model.elements = mesh->element_count;
cleanup:
    mesh_file_destroy(&file);
    simulation->timing.mesh = clock_seconds() - started;
    return error_is_clean(err);
}

static void translate_materials(Simulation *simulation)
{
    const Scene *scene = &simulation->scene;
    simulation->material = (Material){.young = scene->material.young,
                                      .poisson = scene->material.poisson,
                                      .density = scene->material.density,
                                      .eta1 = scene->material.eta1,
                                      .eta2 = scene->material.eta2,
                                      .plane_strain = scene->material.plane == PLANE_STRAIN};
    static const FrictionKind kinds[] = {
        [LAW_COULOMB] = FRICTION_COULOMB,
        [LAW_LINEAR_WEAKENING] = FRICTION_LINEAR_WEAKENING,
        [LAW_EXPONENTIAL_WEAKENING] = FRICTION_EXPONENTIAL_WEAKENING};
    simulation->law = (FrictionLaw){.kind = kinds[scene->friction.law],
                                    .mu_static = scene->friction.mu_static,
                                    .mu_kinetic = scene->friction.mu_kinetic,
                                    .critical_velocity = scene->friction.critical_velocity};
}

// A force to measure by where no load presses: the loads' size, or the impact's.
static double free_scale(const Simulation *simulation, double load)
{
    const Material *material = &simulation->material;
    double impedance = material->density * material_speeds(material).longitudinal;
    double impact = impedance * fabs(simulation->scene.start.velocity_z) * simulation->model.length;
    if (impact > 0) return impact;
    return load < 0 ? -load : material->young * simulation->model.length;
}

static bool add_loads(Simulation *simulation, Error *err)
{
    const Scene *scene = &simulation->scene;
    Bulk *bulk = &simulation->bulk;
    MeshCurve curve;
    if (scene->load.pressure != 0) {
        double traction[2] = {0, -scene->load.pressure};
        TRY(mesh_curve(&simulation->mesh, scene->groups.top, &curve, err));
        bulk_add_traction(&simulation->mesh, &curve, traction, bulk);
    }
    for (int32_t k = 0; k < scene->load.traction_count; k++) {
        double traction[2] = {scene->load.tractions[k].x, scene->load.tractions[k].z};
        TRY(mesh_curve(&simulation->mesh, scene->load.tractions[k].group, &curve, err));
        bulk_add_traction(&simulation->mesh, &curve, traction, bulk);
    }
    double load = 0;
    for (int32_t dof = 1; dof < bulk->dof_count; dof += 2) load -= bulk->load[dof];
    // What is held needs no load, and what flies towards the plane has its momentum.
    bool held = scene->load.support_count > 0 || scene->start.velocity_z < 0;
    if (!(load > 0) && held) load = free_scale(simulation, load);
    if (!(load > 0))
        FAIL(err, ERROR_INPUT,
             "%s: the loads do not press the block onto the plane (their resultant along -z is %g)",
             scene->path, load);
    simulation->scales.load = load;
cleanup:
    return error_is_clean(err);
}

bool model_hold_supports(Simulation *simulation, Error *err)
{
    const Scene *scene = &simulation->scene;
    for (int32_t k = 0; k < scene->load.support_count; k++) {
        const SceneSupport *support = &scene->load.supports[k];
        MeshCurve curve;
        if (!mesh_curve(&simulation->mesh, support->group, &curve, err)) return false;
        for (int32_t i = 0; i < curve.node_count; i++) {
            if (support->x) bulk_hold(2 * curve.nodes[i], &simulation->bulk);
            if (support->z) bulk_hold(2 * curve.nodes[i] + 1, &simulation->bulk);
        }
    }
    return true;
}

// A reduced bulk follows what the interface does: not a load put on at once, nor a velocity that
// supports stop.
static bool starts_at_interface(const Scene *scene)
{
    if (scene->start.state == START_UNDEFORMED) return false;
    for (int32_t k = 0; k < scene->load.support_count; k++) {
        const SceneSupport *support = &scene->load.supports[k];
        if (support->x && scene->start.velocity_x != 0) return false;
        if (support->z && scene->start.velocity_z != 0) return false;
    }
    return true;
}

// E, eta, rho L^2 and the size of the load: what the reduced matrices are normalised with.
static BulkScales bulk_scales(const Simulation *simulation)
{
    const Material *material = &simulation->material;
    double length = simulation->model.length;
    return (BulkScales){.stiffness = material->young,
                        .damping = material->eta1 + material->eta2,
                        .mass = material->density * length * length,
                        .load = dense_max_abs(simulation->bulk.load, simulation->bulk.dof_count)};
}

static bool reduce_bulk(Simulation *simulation, Error *err)
{
    const Interface *interface = &simulation->interface;
    const Bulk *bulk = &simulation->bulk;
    ReductionDef def = {.tolerance = simulation->scene.reduction.tolerance,
                        .scales = bulk_scales(simulation)};
    double mass = 0;
    double *rotation = NEW_ARRAY(double, interface->count, err);
    if (!rotation) goto cleanup;
    TRY(reduction_build(bulk, interface->dofs, interface->count, &def, &simulation->reduced, err));
    for (int32_t k = 0; k < interface->count; k++) {
        const double *position = simulation->mesh.position + 2 * (interface->dofs[k] / 2);
        rotation[k] = interface->dofs[k] % 2 == 0 ? -position[1] : position[0];
    }
    for (int32_t dof = 0; dof < bulk->dof_count; dof += 2) mass += bulk->mass[dof];
    TRY(bulk_operator_reduce(&simulation->reduced, rotation, mass, &simulation->system, err));
cleanup:
    memory_free(rotation);
    return error_is_clean(err);
}

static bool make_operator(Simulation *simulation, Error *err)
{
    const Scene *scene = &simulation->scene;
    const Interface *interface = &simulation->interface;
    bool viscous = scene->material.eta1 > 0;
    bool implicit = scene->time.scheme == SCHEME_SDIRK2;   // explicit steps are those of the mesh
    bool reduces = scene->reduction.use != REDUCE_NEVER && starts_at_interface(scene);
    if (reduces && viscous && implicit) return reduce_bulk(simulation, err);
    return bulk_operator_create(&simulation->bulk, simulation->mesh.position, interface->dofs,
                                interface->count, &simulation->system, err);
}

bool model_build_bulk(Simulation *simulation, Error *err)
{
    const Scene *scene = &simulation->scene;
    double height = simulation->model.height;
    translate_materials(simulation);
    TRY(bulk_assemble(&simulation->mesh, &simulation->material, &simulation->bulk, err));
    TRY(add_loads(simulation, err));
    InterfaceDef def = {.contact_name_count = scene->groups.contact.count,
                        .contact_names = scene->groups.contact.name,
                        .has_rod = scene->rod.kind != ROD_NONE,
                        .rod_name = scene->groups.rod,
                        .rod_height = scene->rod.height > 0 ? scene->rod.height
                                                            : ROD_HEIGHT * height,
                        .rod_width = scene->rod.width > 0 ? scene->rod.width : ROD_WIDTH * height};
    TRY(interface_build(&simulation->mesh, &def, &simulation->interface, err));
    simulation->scales.length = simulation->model.length;
    simulation->model.contact_nodes = simulation->interface.contact_count;
    simulation->model.rod_nodes = simulation->interface.rod_count;
    simulation->model.full_dofs = simulation->bulk.dof_count;
cleanup:
    return error_is_clean(err);
}

bool model_assemble(Simulation *simulation, Error *err)
{
    const Scene *scene = &simulation->scene;
    TRY(model_build_bulk(simulation, err));
    TRY(model_hold_supports(simulation, err));
    TRY(make_operator(simulation, err));
    simulation->model.reduced_dofs = simulation->system.dof_count;
    const Material *material = &simulation->material;
    simulation->scales.time = simulation->model.length / material_speeds(material).longitudinal +
                              (material->eta1 + material->eta2) / material->young;
    simulation->scales.slip_velocity = scene->rod.velocity > 0 ? scene->rod.velocity
                                                               : scene->friction.critical_velocity;
cleanup:
    return error_is_clean(err);
}

// The slip that the drop of friction drives: (mu_S - mu_K) p H / E, with p the mean pressure.
static double friction_slip(const Simulation *simulation)
{
    const FrictionLaw *law = &simulation->law;
    double drop = law->kind == FRICTION_COULOMB ? law->mu_static : law->mu_static - law->mu_kinetic;
    if (drop <= 0) drop = law->mu_static > 0 ? law->mu_static : 1;
    double pressure = simulation->scales.load / simulation->model.length;
    return drop * pressure * simulation->model.height / simulation->material.young;
}

bool model_prepare_steps(Simulation *simulation, Error *err)
{
    const Scene *scene = &simulation->scene;
    double slip = friction_slip(simulation), velocity = scene->rod.velocity;
    simulation->t_end = scene->time.until_t;
    if (scene->time.until_U > 0) {
        double t_end = scene->time.until_U / velocity;
        if (!(simulation->t_end > 0 && simulation->t_end < t_end)) simulation->t_end = t_end;
    }
    double tolerance = scene->time.tolerance > 0 ? scene->time.tolerance
                                                 : TOLERANCES[scene->time.accuracy];
    StepControlDef def = {.tolerance = tolerance * slip,
                          .step_max = simulation->t_end / STEPS_AT_LEAST,
                          .growth_max = 2,
                          .use_certificate = scene->time.certificate};
    if (scene->rod.kind != ROD_NONE)
        def.step_max = fmin(def.step_max, STEP_MAX_SLIP * slip / velocity);
    bool implicit = scene->time.scheme == SCHEME_SDIRK2;   // the keys mean the scheme named
    if (implicit && scene->time.step_max > 0) def.step_max = scene->time.step_max;
    def.step_min = implicit && scene->time.step_min > 0 ? scene->time.step_min
                                                        : STEP_RANGE * def.step_max;
    def.wave_step = scene->time.wave_step * simulation->model.length /
                    material_speeds(&simulation->material).longitudinal;
    RodKind kind = scene->start.rod == START_ROD_HELD && scene->rod.kind != ROD_NONE
                       ? (scene->rod.kind == ROD_PUSH ? ROD_PUSHES : ROD_IS_BONDED)
                       : ROD_AWAY;
    TRY(rod_build(&simulation->interface, kind, 0, &simulation->rod, err));
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
