// SPDX-License-Identifier: GPL-2.0-or-later
// A basis goes by the content of the block that it is made of (reduction/reduction_block), which
// mesh, loads and interface tell: of one that is in the cache no matrix is assembled.
#include "model/obtain.h"

#include "base/clock.h"
#include "base/computation.h"
#include "base/system.h"
#include "contact/contact_half.h"
#include "fem/floor.h"
#include "fem/mesh_locate.h"
#include "reduction/mirror.h"
#include "reduction/reduction.h"
#include "reduction/reduction_block.h"
#include "io/cache/cache_folder.h"
#include "model/assemble.h"
#include "model/basis_cache.h"
#include "model/contact_nodes.h"
#include "model/memory.h"
#include "model/scene_mesh.h"
#include "scene/materials.h"
#include "scene/programs.h"

#include <malloc.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

// Relative error of the interior's responses in the energy norm.
static const double REDUCTION_TOLERANCES[] = {
    [ACCURACY_DRAFT] = 5e-2, [ACCURACY_STANDARD] = 2e-2, [ACCURACY_FINE] = 2e-3};

// Returns true if the scene asks for the inside of the block, not for the interface alone.
static bool wants_modes(const Scene *scene)
{
    return scene->output.fields || scene->output.whole_block || scene->output.probes.count > 0;
}

// The scene's own tolerance, else one that follows from the accuracy it wants.
static double reduction_tolerance(const Scene *scene)
{
    return scene->reduction.tolerance > 0 ? scene->reduction.tolerance
                                          : REDUCTION_TOLERANCES[scene->time.accuracy];
}

// The basis called `name`, from the cache, where it is there and of this block.
static bool load_basis(Model *model, const ReductionBlock *block, const char *name, Error *err)
{
    ReducedBulk *reduced = &model->reduced;
    bool *found = &model->from_cache;
    if (!basis_cache_load(name, wants_modes(model->scene), reduced, found, model->cache_note, err))
        return false;
    if (*found && reduced->part[0].shape_count == block->bulk.spectrum.matrix_count &&
        reduced->interface_count == model->interface.count &&
        reduced->full_dofs == block->bulk.dof_count)
        return true;
    *found = false;
    reduced_bulk_destroy(reduced);
    return true;
}

// Goes on after a reduction that failed with `err`. Under reduction.use: auto an error of computing
// is taken back, and model->not_reduced says why the whole mesh is stepped; under `always` the
// error names that key. Other errors, such as lack of memory, stay: bits must not depend on them.
static bool step_on_mesh(Model *model, Error *err)
{
    if (err->code != ERROR_COMPUTE && err->code != ERROR_LIBRARY) return false;
    if (model->scene->reduction.use == REDUCE_AUTO) {
        snprintf(model->not_reduced, NOT_REDUCED_SIZE, "%.*s", NOT_REDUCED_SIZE - 1, err->message);
        error_clear(err);
        return true;
    }
    error_context(err, "`always`, but rounding leaves no reduction (numbers too far apart?); auto "
                       "steps on the whole mesh");
    err->code = ERROR_INPUT;
    return scene_blame(model->scene, "reduction.use", false, err);
}

// The basis of `block`, built and kept in the cache under its name. Of processes that need it at
// once one builds it and the others wait. Where rounding leaves none the block is not reduced.
static bool build_basis(Model *model, const ReductionBlock *block, const char *name,
                        const StageNotice *notice, Error *err)
{
    const Scene *scene = model->scene;
    const Interface *interface = &model->interface;
    ReductionDef def = {.tolerance = reduction_tolerance(scene),
                        .materials = block->materials,
                        .modes = wants_modes(scene),
                        .no_patches = model->mesh.dim > 2,
                        .one_by_one = model->one_by_one,
                        .node_image = block->image,
                        .position = block->position,
                        .goes_on = notice ? notice->goes_on : NULL,
                        .self = notice ? notice->self : NULL,
                        .scales = {.stiffness = 1, .damping = 1, .mass = 1, .load = 1}};
    FileLock lock = {0};
    if (cache_lock(name, &lock)) TRY(load_basis(model, block, name, err));
    if (model->from_cache) goto cleanup;
    model->is_reduced = reduction_build(&block->bulk, interface->dofs, interface->count, &def,
                                        &model->reduced, err);
    malloc_trim(0);   // what a reduction needs at once nothing needs afterwards
    if (model->is_reduced) {
        basis_cache_store(name, &model->reduced, model->cache_note);
    } else {
        reduced_bulk_destroy(&model->reduced);
        TRY(step_on_mesh(model, err));
    }
cleanup:
    file_lock_release(&lock);
    return error_is_clean(err);
}

// Decides if the bulk is reduced. That takes implicit steps, viscosity in every region (else the
// basis would have to answer for a block that nothing holds together, as it does for all that is
// between elastic and viscous), and states that the interface made: not a load put on at once, nor
// a velocity that supports stop.
static bool ask_reducible(const Scene *scene, bool *reducible, Error *err)
{
    bool viscous = scene->material.eta1 > 0, by_interface = scene->start.state != START_UNDEFORMED;
    for (int32_t i = 0; i < scene->materials.count; i++)
        viscous = viscous &&
                  scene_material_number(scene, &scene->materials.region[i], MATERIAL_ETA1) > 0;
    for (int32_t k = 0; k < scene->load.support_count; k++) {
        const SceneSupport *support = &scene->load.supports[k];
        if (support->x && scene->start.velocity_x != 0) by_interface = false;
        if (support->z && scene->start.velocity_z != 0) by_interface = false;
    }
    const char *obstacle = NULL;
    if (scene->time.scheme == SCHEME_EXPLICIT)
        obstacle = "explicit steps are those of the mesh";
    else if (!viscous)
        obstacle = "a block without viscosity cannot be reduced";
    else if (scene_has_program(&scene->load.program))
        obstacle = "a load that changes needs the mesh";
    else if (!by_interface)
        obstacle = "a start that the interface does not make needs the mesh";
    *reducible = !obstacle && scene->reduction.use != REDUCE_NEVER;
    if (!obstacle || scene->reduction.use != REDUCE_ALWAYS) return true;
    error_set(err, ERROR_INPUT, __FILE__, __LINE__, "`always`, but %s: auto or never", obstacle);
    return scene_blame(scene, "reduction.use", false, err);
}

// Part of the computer's memory from which on parts of a reduction are built one after another,
// where that takes less: not in the plane, nor where the steps take more than the reduction.
static const double ONE_BY_ONE_FROM = 0.3;

// Said before anything is factored; in space, where it goes up with the fourth power of the cells
// along a side.
static bool check_memory(Model *model, int32_t parts, Error *err)
{
    MemorySizes sizes = {.space = model->mesh.dim > 2,
                         .unknowns = model->bulk.dof_count,
                         .interface = model->interface.count,
                         .parts = parts,
                         .modes = wants_modes(model->scene)};
    ContactHalf half = {0};
    TRY(contact_half_find(&model->interface, &half, err));
    sizes.one_side = half.interface.contact_count > 0;
    double have = system_memory(), whole = memory_expected(&sizes, false);
    model->memory = memory_expected(&sizes, model->is_reduced);
    sizes.one_by_one = true;
    double less = memory_expected(&sizes, model->is_reduced);
    model->one_by_one = model->memory > ONE_BY_ONE_FROM * have && less < model->memory;
    if (model->one_by_one) model->memory = less;
    if (model->scene->time.scheme == SCHEME_EXPLICIT) model->memory = 0;
    if (model->memory > have) {
        sizes.modes = false;
        double bare = memory_expected(&sizes, model->is_reduced);
        const char *way_out = "";
        if (model->is_reduced && whole < have)
            way_out = ", or reduction.use: never, which takes less memory and longer";
        if (bare < have)
            way_out =
                ", or neither output.fields nor probes, for which the block's motions are kept";
        FAIL(err, ERROR_INPUT,
             "%s: %d contact nodes are too many for this computer: a run takes some %.0f "
             "GB of memory, and there are %.1f; coarser cells at the contact are needed%s",
             model->scene->path, model->interface.contact_count, model->memory / 1e9, have / 1e9,
             way_out);
    }
cleanup:
    contact_half_destroy(&half);
    return error_is_clean(err);
}

// Finds the probes of the scene in its mesh, places [SCENE_PROBES_MAX]. ERROR_INPUT: a probe has
// another number of coordinates than the mesh, or lies outside of all bodies; it says which body is
// nearest, and where.
static bool find_probes(const Scene *scene, const Mesh *mesh, ProbePlace *places, Error *err)
{
    const SceneProbes *probes = &scene->output.probes;
    for (int32_t k = 0; k < probes->count; k++) {
        const SceneProbe *probe = &probes->probe[k];
        char asked[PLACE_TEXT_SIZE], nearest[PLACE_TEXT_SIZE];
        char low[PLACE_TEXT_SIZE], high[PLACE_TEXT_SIZE];
        double distance = 0;
        bool found = true;
        if (probe->at.count != mesh->dim)
            found = REFUSE(err, "`%s` has `at` with %d number%s; allowed: %s, as the mesh is in %s",
                           probe->name, probe->at.count, probe->at.count == 1 ? "" : "s",
                           mesh->dim == 2 ? "[x, z]" : "[x, y, z]",
                           mesh->dim == 2 ? "the plane" : "space");
        else
            places[k].element = mesh_locate(mesh, probe->at.value, places[k].at);
        if (found && places[k].element < 0) {
            // The place is outside: says what is nearest to it, and how far the block reaches.
            int32_t node = mesh_nearest_node(mesh, probe->at.value, &distance);
            MeshPlace from = {mesh->x_min, mesh->dim == 2 ? mesh->z_min : mesh->y_min, mesh->z_min};
            MeshPlace to = {mesh->x_max, mesh->dim == 2 ? mesh->z_max : mesh->y_max, mesh->z_max};
            found = REFUSE(
                err,
                "`%s` is at %s, outside of the block%s: %s at %s, %g away; the block reaches from "
                "%s to %s",
                probe->name, place_text(mesh->dim, probe->at.value, asked),
                mesh->is_base ? " and its base" : "",
                !mesh->is_base             ? "its nearest node is"
                : mesh_in_base(mesh, node) ? "the nearest node is one of the base,"
                                           : "the nearest node is one of the block,",
                mesh_place_text(mesh, node, nearest), distance, place_text(mesh->dim, from, low),
                place_text(mesh->dim, to, high));
        }
        if (!scene_blame(scene, "output.probes", found, err)) return false;
    }
    return true;
}

// Does all that comes before matrices are factored: makes mesh, loads and interface, finds whether
// the bulk is to be reduced, and loads the basis if the cache has it. name: of the basis in the
// cache, if the bulk is reduced.
static bool prepare(const StageNotice *notice, Model *model, ReductionBlock *block,
                    char name[HASH_TEXT_SIZE], Error *err)
{
    const Scene *scene = model->scene;
    int32_t parts = 1;
    int64_t limit;   // of the cache that is to be used
    if (!ask_reducible(scene, &model->is_reduced, err)) return false;
    if (scene->reduction.cache && !cache_folder_limit(&limit, err)) return false;
    if (notice && !notice->tell(notice->self, "meshing", err)) return false;
    ChildWatch watch = {0};
    if (notice) watch = (ChildWatch){.goes_on = notice->goes_on, .self = notice->self};
    if (!model_read_mesh(notice ? &watch : NULL, model, err) || !model_lay_bulk(model, err))
        return false;
    if (!find_probes(scene, &model->mesh, model->probes, err)) return false;

    // A pushing rod comes from behind: on the leading face it would have to stand inside the block.
    const Interface *interface = &model->interface;
    double reach = 0;   // the greatest x of a rod node, from the trailing end
    for (int32_t j = 0; j < interface->rod_count; j++)
        reach =
            fmax(reach, mesh_place(&model->mesh, interface->rod_node[j])[0] - model->mesh.x_min);
    if (scene->rod.kind == ROD_PUSH && reach / model->length > 0.5)
        return REFUSE(err,
                      "%s: rod.kind: push, but group `%s` is on the leading half of the block, "
                      "which a rod that moves along +x cannot push; let it pull there (rod.kind: "
                      "bonded) or name the trailing face (groups.rod)",
                      scene->path, scene->groups.rod);
    if (!model_hold_supports(model, err)) return false;
    if (!model->is_reduced) return check_memory(model, parts, err);

    // The block that is reduced, with its matrices where the cache does not have its basis. Its
    // name in the cache is a hash of all that the basis depends on; empty for none.
    double load = model->unit_load.size * load_reference(model);
    if (!reduction_block_create(&model->mesh, &model->bulk, &model->materials, load, block, err))
        return false;
    Hash hash = computation_hash_bits();
    name[0] = 0;
    if (scene->reduction.cache) {
        hash_number(&hash, reduction_tolerance(scene));
        reduction_block_hash(block, &model->mesh, interface->dofs, interface->count, &hash);
        hash_write(&hash, name);
    }
    if (!load_basis(model, block, name, err)) return false;
    parts = model->reduced.part_count;   // where it is from the cache
    if (!model->from_cache && !(reduction_block_assemble(&model->mesh, block, err) &&
                                mirror_count_parts(&block->bulk, block->image, interface->dofs,
                                                   interface->count, &parts, err)))
        return false;
    return check_memory(model, parts, err);
}

bool model_forecast(const Scene *scene, Model *model, Error *err)
{
    char name[HASH_TEXT_SIZE];
    ReductionBlock block = {0};
    *model = model_of(scene);
    bool done = prepare(NULL, model, &block, name, err);
    reduction_block_destroy(&block);
    return done;
}

bool model_obtain(const Scene *scene, const StageNotice *notice, Model *model, Error *err)
{
    double started = clock_seconds();
    char name[HASH_TEXT_SIZE];
    ReductionBlock block = {0};
    *model = model_of(scene);
    const Interface *interface = &model->interface;
    TRY(prepare(notice, model, &block, name, err));
    if (notice && !model->from_cache) TRY(notice->tell(notice->self, "reducing", err));
    if (model->is_reduced && !model->from_cache) TRY(build_basis(model, &block, name, notice, err));
    if (!model->is_reduced) reduction_block_destroy(&block);
    const Material *material = &model->materials.mean;
    double length = model->length;
    if (model->is_reduced) {
        // Steps on the reduced bulk that is there. Matrices are kept normalised; the scales of this
        // scene are set here and multiply whatever is asked of them: E, eta, rho L^2 (in space
        // times L) and the size of the load.
        double depth = interface->dim > 2 ? length : 1;
        model->reduced.scales = (BulkScales){.stiffness = material->young * depth,
                                             .damping = (material->eta1 + material->eta2) * depth,
                                             .mass = material->density * length * length * depth,
                                             .load = model->unit_load.size * load_reference(model)};

        // The quotient is taken again: it may differ from `depth` in the last bit, which is part of
        // the bits of a run.
        depth = model->reduced.scales.stiffness / material->young;
        model->reduced.spectrum = spectrum_scaled(&model->bulk.spectrum, depth, 1);
        TRY(bulk_operator_reduce(&model->reduced, length,
                                 model->reduced.area * model->reduced.scales.mass, &model->system,
                                 err));
    } else
        TRY(bulk_assemble(&model->mesh, model->materials.list, &model->bulk, err) &&
            bulk_operator_create(&model->bulk, model->mesh.position, interface->dofs,
                                 interface->count, &model->system, err));
    model->system.machine = model_machine(model);

    // Explicit steps move nodes, one by one: over a base they need matrices that know of no jumps.
    if (model->mesh.is_base && scene->time.scheme == SCHEME_EXPLICIT) {
        Bulk *nodes = &model->bulk_of_nodes;
        Mesh without_floor = model->mesh;   // borrows all
        without_floor.floor = (Floor){0};
        if (!model->mesh.floor.matches)
            FAIL(err, ERROR_INPUT,
                 "%s: time.scheme: explicit needs a floor whose nodes lie under those of the "
                 "contact, each under one; implicit steps take any",
                 scene->path);
        TRY(bulk_create(&without_floor, nodes, err));
        size_t unknowns = (size_t)nodes->dof_count;
        memcpy(nodes->load, model->bulk.load, unknowns * sizeof *nodes->load);
        floor_scatter(&model->mesh, nodes->load);
        nodes->spectrum = model->bulk.spectrum;
        memcpy(nodes->held, model->bulk.held, unknowns * sizeof *nodes->held);
        TRY(bulk_assemble(&without_floor, model->materials.list, nodes, err));
    }
    TRY(model_lay_laws(model, err));
    TRY(model_lay_gaps(model, err));

    // Scales by which velocities and times are measured.
    model->scales.length = length;
    model->scales.trailing = model->middle - 0.5 * length;
    model->scales.time = length / material_speeds(material).longitudinal +
                         materials_viscous_time(&model->materials);
    model->scales.slip_velocity = scene->rod.velocity > 0 ? scene->rod.velocity
                                                          : model_law(model)->critical_velocity;
    // Nothing gives a velocity: that with which the load would deform the block in that time.
    if (!(model->scales.slip_velocity > 0))
        model->scales.slip_velocity = model->scales.load / model->breadth / material->young /
                                      model->scales.time;
cleanup:
    reduction_block_destroy(&block);
    model->seconds_reduce = clock_seconds() - started - model->seconds_mesh;
    return error_is_clean(err);
}
