// SPDX-License-Identifier: GPL-2.0-or-later
// The shape a scene steps on: read, assembled and reduced, or taken from the cache.
//
// A Shape (model/shape_cache) is what of the mesh the time loop needs: interface, sizes, how a
// rigid rotation moves the interface, and the name of a basis. With fields asked for the mesh is
// read in any case, since VTU files need its nodes.
#include "model/model.h"

#include "base/clock.h"
#include "base/dense.h"
#include "base/memory.h"
#include "bulk/reduction_block.h"
#include "model/basis_cache.h"

#include <math.h>
#include <string.h>

// Of the interior's responses, in the energy norm.
static const double REDUCTION_TOLERANCES[] = {
    [ACCURACY_DRAFT] = 5e-2, [ACCURACY_STANDARD] = 2e-2, [ACCURACY_FINE] = 2e-3};

// Through gmsh, the slowest part of a small run (76 ms to load).
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

// Scene to material and friction law: the same numbers, other structs.
static void translate_materials(Simulation *simulation)
{
    const Scene *scene = &simulation->scene;
    simulation->material = (Material){.young = scene->material.young,
                                      .poisson = scene->material.poisson,
                                      .density = scene->material.density,
                                      .eta1 = scene->material.eta1,
                                      .eta2 = scene->material.eta2,
                                      .plane_strain = scene->material.plane == PLANE_STRAIN};
    simulation->model.speeds = material_speeds(&simulation->material);
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
// Force per width: of an impact, the stress rho c_L v over the length.
static double free_scale(const Simulation *simulation, double load)
{
    const Material *material = &simulation->material;
    double impedance = material->density * material_speeds(material).longitudinal;
    double impact = impedance * fabs(simulation->scene.start.velocity_z) * simulation->model.length;
    if (impact > 0) return impact;
    return load < 0 ? -load : material->young * simulation->model.length;
}

// Pressure and tractions onto the bulk's load, first per unit of load_reference(): so what the
// cache keeps of them has the same bits whichever pressure asked first. F_N, their resultant
// towards the plane, becomes the force that others are measured with.
static bool add_loads(Simulation *simulation, Error *err)
{
    const Scene *scene = &simulation->scene;
    Bulk *bulk = &simulation->bulk;
    MeshCurve curve;
    double reference = load_reference(scene), unit = 0;
    if (scene->load.pressure != 0) {
        double traction[2] = {0, -scene->load.pressure / reference};
        TRY(mesh_curve(&simulation->mesh, scene->groups.top, &curve, err));
        bulk_add_traction(&simulation->mesh, &curve, traction, bulk);
    }
    for (int32_t k = 0; k < scene->load.traction_count; k++) {
        const SceneTraction *given = &scene->load.tractions[k];
        double traction[2] = {given->x / reference, given->z / reference};
        TRY(mesh_curve(&simulation->mesh, given->group, &curve, err));
        bulk_add_traction(&simulation->mesh, &curve, traction, bulk);
    }
    for (int32_t dof = 1; dof < bulk->dof_count; dof += 2) unit -= bulk->load[dof];
    simulation->unit_load.size = dense_max_abs(bulk->load, bulk->dof_count);
    simulation->unit_load.resultant = unit;
    for (int32_t dof = 0; dof < bulk->dof_count; dof++) bulk->load[dof] *= reference;
    double load = unit * reference;
    // What is held needs no load, and what flies towards the plane has its momentum.
    bool held = scene->load.support_count > 0 || scene->start.velocity_z < 0;
    if (!(load > 0) && held) {
        load = free_scale(simulation, load);
        simulation->unit_load.resultant = load / reference;
    }
    if (!(load > 0))
        FAIL(err, ERROR_INPUT,
             "%s: the loads do not press the block onto the plane (their resultant along -z is %g)",
             scene->path, load);
    simulation->scales.load = load;
cleanup:
    return error_is_clean(err);
}

// Supports are no part of the cached shape: their unknowns leave the assembled matrices.
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
static BulkScales bulk_scales(const Simulation *simulation, double load)
{
    const Material *material = &simulation->material;
    double length = simulation->model.length;
    return (BulkScales){.stiffness = material->young,
                        .damping = material->eta1 + material->eta2,
                        .mass = material->density * length * length,
                        .load = load};
}

// As the scene says, else by the accuracy it wants.
static double reduction_tolerance(const Scene *scene)
{
    return scene->reduction.tolerance > 0 ? scene->reduction.tolerance
                                          : REDUCTION_TOLERANCES[scene->time.accuracy];
}

// Moves the interface of `shape` into the simulation and steps on the reduced bulk that is there.
// Matrices are kept normalised; the scales of this scene (E, eta, rho L^2, load) are set here and
// multiply whatever is asked of them.
static bool adopt_shape(Simulation *simulation, Shape *shape, Error *err)
{
    double load = shape->sizes.load_size * load_reference(&simulation->scene);
    simulation->interface = shape->interface;
    shape->interface = (Interface){0};
    simulation->model.length = shape->sizes.length;
    simulation->model.height = shape->sizes.height;
    simulation->model.elements = (int32_t)shape->sizes.elements;
    simulation->model.full_dofs = (int32_t)shape->sizes.full_dofs;
    simulation->reduced.scales = bulk_scales(simulation, load);
    simulation->scales.load = shape->sizes.load_resultant * load_reference(&simulation->scene);
    return bulk_operator_reduce(&simulation->reduced, shape->rotation,
                                shape->sizes.area * simulation->material.density,
                                &simulation->system, err);
}

// What the unit rotation about the trailing end does to the interface's unknowns.
static bool list_rotation(const Simulation *simulation, const ReductionBlock *block, Shape *shape,
                          Error *err)
{
    const Interface *interface = &shape->interface;
    shape->rotation = NEW_ARRAY(double, interface->count, err);
    for (int32_t k = 0; shape->rotation && k < interface->count; k++) {
        const double *at = block->position + 2 * (interface->dofs[k] / 2);
        double turned = interface->dofs[k] % 2 == 0 ? -at[1] : at[0];
        shape->rotation[k] = turned * simulation->model.length;
    }
    return shape->rotation != NULL;
}

// The basis of `block`, from the cache or built and kept there; where it is kept, its name goes
// into the shape. Of processes that need it at once one builds it and the others wait.
static bool obtain_basis(Simulation *simulation, const ReductionBlock *block, Shape *shape,
                         Error *err)
{
    const Scene *scene = &simulation->scene;
    const Interface *interface = &shape->interface;
    ReductionDef def = {.tolerance = reduction_tolerance(scene),
                        .scales = {.stiffness = 1, .damping = 1, .mass = 1, .load = 1}};
    bool *found = &simulation->model.from_cache;
    bool with_modes = scene->output.fields;
    char *note = simulation->cache_note;
    FileLock lock = {0};
    if (scene->reduction.cache) {
        Hash hash = hash_start();
        hash_text(&hash, BASIS_FORMAT);
        hash_number(&hash, def.tolerance);
        reduction_block_hash(block, &simulation->mesh, interface->dofs, interface->count, &hash);
        hash_write(&hash, shape->basis);
    }
    TRY(basis_cache_load(shape->basis, with_modes, &simulation->reduced, found, note, err));
    if (*found) goto cleanup;
    if (basis_cache_lock(shape->basis, &lock))
        TRY(basis_cache_load(shape->basis, with_modes, &simulation->reduced, found, note, err));
    if (*found) goto cleanup;
    TRY(reduction_build(&block->bulk, interface->dofs, interface->count, &def, &simulation->reduced,
                        err));
    if (!basis_cache_store(shape->basis, &simulation->reduced, note)) shape->basis[0] = 0;
cleanup:
    file_lock_release(&lock);
    return error_is_clean(err);
}

// Reduces the assembled bulk; key: where the cache keeps the shape, empty for nowhere.
static bool reduce_bulk(Simulation *simulation, const char *key, Error *err)
{
    const Bulk *bulk = &simulation->bulk;
    double load = simulation->unit_load.size * load_reference(&simulation->scene);
    ReductionBlock block = {0};
    Shape shape = {.sizes = {.length = simulation->model.length,
                             .height = simulation->model.height,
                             .area = bulk->area,
                             .elements = simulation->model.elements,
                             .full_dofs = bulk->dof_count,
                             .load_size = simulation->unit_load.size,
                             .load_resultant = simulation->unit_load.resultant}};
    shape.interface = simulation->interface;
    simulation->interface = (Interface){0};
    TRY(reduction_block_create(&simulation->mesh, bulk, &simulation->material, load, &block, err));
    TRY(list_rotation(simulation, &block, &shape, err));
    TRY(obtain_basis(simulation, &block, &shape, err));
    if (shape.basis[0]) shape_cache_store(key, &shape, simulation->cache_note);
    TRY(adopt_shape(simulation, &shape, err));
cleanup:
    reduction_block_destroy(&block);
    shape_destroy(&shape);
    return error_is_clean(err);
}

// The scene's bulk can be reduced: stepped implicitly, with viscosity, from states the interface
// made.
static bool is_reducible(const Scene *scene)
{
    bool implicit = scene->time.scheme != SCHEME_EXPLICIT;   // explicit steps are those of the mesh
    return scene->reduction.use != REDUCE_NEVER && implicit && scene->material.eta1 > 0 &&
           starts_at_interface(scene);
}

// Seconds, by n unknowns of the mesh and m of the interface; of set A to 160 x 160 cells. A stage
// costs about 10 products with some 3 m x 3 m entries when reduced, and passes over the factor's
// entries, about 5 n log2 n of them, when not. A basis costs dense products of n x m responses.
static const double REDUCED_STAGE = 16e-9, FULL_STAGE = 14e-9, REDUCTION = 4e-9;
static const double STAGES = 3000;   // of a run with some slidings; more, and it pays sooner
static const double REDUCTION_BYTES = 64, REDUCTION_BYTES_MAX = 4e9;   // each n m; in all

// Building a basis and stepping on it is expected to be done before stepping on the sparse factors
// would be. From about 200 x 200 cells on it is not.
static bool reduction_pays(const Simulation *simulation)
{
    if (simulation->scene.reduction.use == REDUCE_ALWAYS) return true;
    double m = simulation->interface.count, n = simulation->bulk.dof_count;
    double reduced = REDUCTION * n * m * m + STAGES * REDUCED_STAGE * m * m;
    return reduced < STAGES * FULL_STAGE * n * log2(n) &&
           REDUCTION_BYTES * n * m < REDUCTION_BYTES_MAX;
}

void model_rod_strip(const Scene *scene, double height, double *middle, double *width)
{
    static const double standard_middle = 0.5, standard_width = 0.1;   // of H
    *middle = scene->rod.height > 0 ? scene->rod.height : standard_middle * height;
    *width = scene->rod.width > 0 ? scene->rod.width : standard_width * height;
}

// The assembled bulk of the full mesh, its loads and its interface; needed to build a basis, to
// find one by content, and wherever nothing is reduced.
bool model_build_bulk(Simulation *simulation, Error *err)
{
    const Scene *scene = &simulation->scene;
    double middle = 0, width = 0;
    model_rod_strip(scene, simulation->model.height, &middle, &width);
    translate_materials(simulation);
    TRY(bulk_assemble(&simulation->mesh, &simulation->material, &simulation->bulk, err));
    TRY(add_loads(simulation, err));
    InterfaceDef def = {.contact_name_count = scene->groups.contact.count,
                        .contact_names = scene->groups.contact.name,
                        .has_rod = scene->rod.kind != ROD_NONE,
                        .rod_name = scene->groups.rod,
                        .rod_height = middle,
                        .rod_width = width,
                        .rod_in_part = scene->rod.ends == ROD_ENDS_EXACT};
    TRY(interface_build(&simulation->mesh, &def, &simulation->interface, err));
    simulation->scales.length = simulation->model.length;
    simulation->model.contact_nodes = simulation->interface.contact_count;
    simulation->model.rod_nodes = simulation->interface.rod_count;
    simulation->model.full_dofs = simulation->bulk.dof_count;
cleanup:
    return error_is_clean(err);
}

// Any rod node on the leading half.
static bool rod_leads(const Simulation *simulation)
{
    const Interface *interface = &simulation->interface;
    const Mesh *mesh = &simulation->mesh;
    double middle = 0.5 * (mesh->x_min + mesh->x_max);
    for (int32_t j = 0; j < interface->rod_count; j++)
        if (mesh->position[2 * interface->rod_node[j]] > middle) return true;
    return false;
}

static bool assemble_operator(Simulation *simulation, const char *key, Error *err)
{
    const Interface *interface = &simulation->interface;
    TRY(model_build_bulk(simulation, err));
    // A pushing rod comes from behind: on the leading face it would have to stand inside the block.
    bool leads = rod_leads(simulation);
    if (leads && simulation->scene.rod.kind == ROD_PUSH)
        FAIL(err, ERROR_INPUT,
             "%s: rod.kind: push, but group `%s` is on the leading half of the block, which a rod "
             "that moves along +x cannot push; let it pull there (rod.kind: bonded) or name the "
             "trailing face (groups.rod)",
             simulation->scene.path, simulation->scene.groups.rod);
    if (leads) key = "";   // a push must not find it in the cache
    TRY(model_hold_supports(simulation, err));
    if (is_reducible(&simulation->scene) && reduction_pays(simulation))
        TRY(reduce_bulk(simulation, key, err));
    else
        TRY(bulk_operator_create(&simulation->bulk, simulation->mesh.position, interface->dofs,
                                 interface->count, &simulation->system, err));
cleanup:
    return error_is_clean(err);
}

// The shape's key, where it can be kept: supports are part of the assembled bulk only.
static bool find_key(Simulation *simulation, char key[HASH_TEXT_SIZE], Error *err)
{
    const Scene *scene = &simulation->scene;
    key[0] = 0;
    bool moves = scene->start.velocity_x != 0 || scene->start.velocity_z != 0;
    if (!is_reducible(scene) || scene->load.support_count > 0 || moves) return true;
    return shape_key(scene, reduction_tolerance(scene), key, err);
}

// A shape and its basis, both from the cache; *found: they were there.
static bool find_shape(Simulation *simulation, const char *key, Shape *shape, bool *found,
                       Error *err)
{
    *found = false;
    if (!key[0]) return true;
    TRY(shape_cache_load(key, shape, found, simulation->cache_note, err));
    if (*found)
        TRY(basis_cache_load(shape->basis, simulation->scene.output.fields, &simulation->reduced,
                             found, simulation->cache_note, err));
    *found = *found && simulation->reduced.interface_count == shape->interface.count;
    if (!*found) {
        shape_destroy(shape);
        reduction_destroy(&simulation->reduced);
    }
    simulation->model.from_cache = *found;
cleanup:
    return error_is_clean(err);
}

// What velocities and times are measured with.
static void set_scales(Simulation *simulation)
{
    const Scene *scene = &simulation->scene;
    const Material *material = &simulation->material;
    double length = simulation->model.length;
    simulation->scales.length = length;
    simulation->scales.time = length / material_speeds(material).longitudinal +
                              (material->eta1 + material->eta2) / material->young;
    simulation->scales.slip_velocity = scene->rod.velocity > 0 ? scene->rod.velocity
                                                               : scene->friction.critical_velocity;
    // Nothing gives a velocity: that with which the load would deform the block in that time.
    if (!(simulation->scales.slip_velocity > 0))
        simulation->scales.slip_velocity = simulation->scales.load / material->young /
                                           simulation->scales.time;
}

// Three ways, the shortest that is open: shape and basis from the cache; meshed and assembled, the
// basis from the cache; all made here.
bool model_obtain(Simulation *simulation, Error *err)
{
    double started = clock_seconds();
    char key[HASH_TEXT_SIZE];
    Shape shape = {0};
    bool found = false;
    translate_materials(simulation);
    TRY(find_key(simulation, key, err));
    TRY(find_shape(simulation, key, &shape, &found, err));
    if (!found || simulation->scene.output.fields) TRY(model_read_mesh(simulation, err));
    if (found)
        TRY(adopt_shape(simulation, &shape, err));
    else
        TRY(assemble_operator(simulation, key, err));
    simulation->model.contact_nodes = simulation->interface.contact_count;
    simulation->model.rod_nodes = simulation->interface.rod_count;
    simulation->model.reduced_dofs = simulation->system.dof_count;
    set_scales(simulation);
cleanup:
    shape_destroy(&shape);
    simulation->timing.reduce = clock_seconds() - started - simulation->timing.mesh;
    return error_is_clean(err);
}
