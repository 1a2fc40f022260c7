// SPDX-License-Identifier: GPL-2.0-or-later
// A Shape (model/shape_cache) is what of the mesh the time loop needs: interface, sizes, how a
// rigid rotation moves the interface, and the name of a basis. With fields asked for the mesh is
// read in any case, since VTU files need its nodes.
#include "model/obtain.h"

#include "base/clock.h"
#include "base/computation.h"
#include "base/memory.h"
#include "reduction/mirror.h"
#include "reduction/symmetry_reduction.h"
#include "reduction/reduction_block.h"
#include "io/cache/cache_folder.h"
#include "model/assemble.h"
#include "model/basis_cache.h"
#include "model/contact_laws.h"
#include "model/extremes.h"
#include "model/gaps.h"
#include "model/shape_cache.h"
#include "model/stages.h"
#include "scene/materials.h"

#include <malloc.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

// Of the interior's responses, in the energy norm.
static const double REDUCTION_TOLERANCES[] = {
    [ACCURACY_DRAFT] = 5e-2, [ACCURACY_STANDARD] = 2e-2, [ACCURACY_FINE] = 2e-3};

// What happens inside of the block is asked for, not the interface alone.
static bool wants_mesh(const Scene *scene)
{
    return scene->output.fields || scene->output.whole;
}

// A reduced bulk follows what the interface does: not a load put on at once or changed, nor a
// velocity that supports stop.
static bool starts_at_interface(const Scene *scene)
{
    if (scene->start.state == START_UNDEFORMED || scene->load.program.factor.count > 0)
        return false;
    for (int32_t k = 0; k < scene->load.support_count; k++) {
        const SceneSupport *support = &scene->load.supports[k];
        if (support->x && scene->start.velocity_x != 0) return false;
        if (support->z && scene->start.velocity_z != 0) return false;
    }
    return true;
}

// E, eta, rho L^2 (in space times L) and the size of the load: what the reduced matrices are
// normalised with.
static BulkScales bulk_scales(const Model *model, double load)
{
    const Material *material = &model->materials.mean;
    double length = model->length, deep = model->interface.dim > 2 ? length : 1;
    return (BulkScales){.stiffness = material->young * deep,
                        .damping = (material->eta1 + material->eta2) * deep,
                        .mass = material->density * length * length * deep,
                        .load = load};
}

// As the scene says, else by the accuracy it wants.
static double reduction_tolerance(const Scene *scene)
{
    return scene->reduction.tolerance > 0 ? scene->reduction.tolerance
                                          : REDUCTION_TOLERANCES[scene->time.accuracy];
}

// Moves the interface of `shape` into the model and steps on the reduced bulk that is there.
// Matrices are kept normalised; the scales of this scene (E, eta, rho L^2, load) are set here and
// multiply whatever is asked of them.
static bool adopt_shape(Model *model, Shape *shape, Error *err)
{
    double load = shape->sizes.load_size * load_reference(model->scene);
    model->interface = shape->interface;
    shape->interface = (Interface){0};
    model->length = shape->sizes.length;
    model->height = shape->sizes.height;
    model->breadth = shape->sizes.breadth;
    model->middle = shape->sizes.middle;
    model->elements = (int32_t)shape->sizes.elements;
    model->full_dofs = (int32_t)shape->sizes.full_dofs;
    memcpy(model->rod_end, shape->sizes.rod_end, sizeof model->rod_end);
    model->contact_region = (int32_t)shape->sizes.contact_region;
    memcpy(model->materials.area, shape->sizes.region_area, sizeof shape->sizes.region_area);
    memcpy(model->materials.width, shape->sizes.region_width, sizeof shape->sizes.region_width);
    if (model->interface.dim > 2 && !model_take_to_space(model, err)) return false;
    materials_find_mean(&model->materials);
    model->reduced.scales = bulk_scales(model, load);
    model->is_reduced = true;
    return model_set_load(model, shape->sizes.load_resultant, err) &&
           bulk_operator_reduce(&model->reduced, model->length,
                                shape->sizes.area * model->materials.mean.density, &model->system,
                                err);
}

// That of the shape's name, from the cache; *found: it is there, and of this block.
static bool load_basis(Model *model, const ReductionBlock *block, const Shape *shape, Error *err)
{
    ReducedBulk *reduced = &model->reduced;
    bool *found = &model->from_cache;
    if (!basis_cache_load(shape->basis, wants_mesh(model->scene), reduced, found, model->cache_note,
                          err))
        return false;
    if (*found && reduced->interface_count == shape->interface.count &&
        reduced->full_dofs == block->bulk.dof_count)
        return true;
    *found = false;
    reduced_bulk_destroy(reduced);
    return true;
}

// The basis of `block`, from the cache or built and kept there; where it is kept, its name goes
// into the shape. Of processes that need it at once one builds it and the others wait.
static bool obtain_basis(Model *model, const ReductionBlock *block, Shape *shape, Error *err)
{
    const Scene *scene = model->scene;
    const Interface *interface = &shape->interface;
    ReductionDef def = {.tolerance = reduction_tolerance(scene),
                        .materials = block->materials,
                        .modes = wants_mesh(scene),
                        .no_patches = model->mesh.dim > 2,
                        .node_image = block->image,
                        .position = block->position,
                        .scales = {.stiffness = 1, .damping = 1, .mass = 1, .load = 1}};
    FileLock lock = {0};
    if (scene->reduction.cache) {
        Hash hash = computation_hash_bits();
        hash_number(&hash, def.tolerance);
        reduction_block_hash(block, &model->mesh, interface->dofs, interface->count, &hash);
        hash_write(&hash, shape->basis);
    }
    TRY(load_basis(model, block, shape, err));
    if (model->from_cache) goto cleanup;
    if (cache_lock(shape->basis, &lock)) TRY(load_basis(model, block, shape, err));
    if (model->from_cache) goto cleanup;
    bool built = symmetry_reduction_build(&block->bulk, interface->dofs, interface->count, &def,
                                          &model->reduced, err);
    TRY(model_blame_extremes(model, built, err));
    malloc_trim(0);   // what a reduction needs at once nothing needs afterwards
    if (!basis_cache_store(shape->basis, &model->reduced, model->cache_note)) shape->basis[0] = 0;
cleanup:
    file_lock_release(&lock);
    return error_is_clean(err);
}

// The greatest x of a rod node, from the trailing end over the block's length; 0 without a rod.
static double rod_reach(const Model *model)
{
    const Interface *interface = &model->interface;
    const Mesh *mesh = &model->mesh;
    double reach = 0;
    for (int32_t j = 0; j < interface->rod_count; j++)
        reach = fmax(reach, mesh_place(mesh, interface->rod_node[j])[0] - mesh->x_min);
    return reach / model->length;
}

// Reduces the assembled bulk; key: where the cache keeps the shape, empty for nowhere.
static bool reduce_bulk(Model *model, const char *key, Error *err)
{
    const Bulk *bulk = &model->bulk;
    double load = model->unit_load.size * load_reference(model->scene);
    ReductionBlock block = {0};
    Shape shape = {.sizes = {.length = model->length,
                             .height = model->height,
                             .breadth = model->breadth,
                             .middle = model->middle,
                             .area = bulk->area,
                             .elements = model->elements,
                             .full_dofs = bulk->dof_count,
                             .load_size = model->unit_load.size,
                             .load_resultant = model->unit_load.resultant,
                             .rod_reach = rod_reach(model),
                             .contact_region = model->contact_region}};
    memcpy(shape.sizes.rod_end, model->rod_end, sizeof model->rod_end);
    memcpy(shape.sizes.region_area, model->materials.area, sizeof shape.sizes.region_area);
    memcpy(shape.sizes.region_width, model->materials.width, sizeof shape.sizes.region_width);
    shape.interface = model->interface;
    model->interface = (Interface){0};
    TRY(reduction_block_create(&model->mesh, bulk, &model->materials, load, &block, err));
    TRY(obtain_basis(model, &block, &shape, err));
    if (shape.basis[0]) shape_cache_store(key, &shape, model->cache_note);
    TRY(adopt_shape(model, &shape, err));
cleanup:
    reduction_block_destroy(&block);
    shape_destroy(&shape);
    return error_is_clean(err);
}

// In every region: else the basis would have to answer for a block that nothing holds together, as
// it does for all that is between elastic and viscous.
static bool is_viscous(const Scene *scene)
{
    bool viscous = scene->material.eta1 > 0;
    for (int32_t i = 0; i < scene->materials.count; i++)
        viscous = viscous &&
                  scene_material_number(scene, &scene->materials.region[i], MATERIAL_ETA1) > 0;
    return viscous;
}

// The scene's bulk can be reduced: implicitly, with viscosity, from states that the
// interface made.
static bool is_reducible(const Model *model)
{
    const Scene *scene = model->scene;
    bool implicit = scene->time.scheme != SCHEME_EXPLICIT;   // explicit steps are those of the mesh
    bool allowed = scene->reduction.use != REDUCE_NEVER && scene->reduction.decided != REDUCE_NEVER;
    return allowed && implicit && is_viscous(scene) && starts_at_interface(scene);
}

// Sets what the run is expected to cost. held: the basis is in the cache.
static bool expect(Model *model, bool held, Error *err)
{
    const Scene *scene = model->scene;
    const Mesh *mesh = &model->mesh;
    int32_t parts = held ? model->reduced.part_count : 1;
    if (!held && is_reducible(model) &&
        !mirror_likely_parts(&model->bulk, mesh->position, model->interface.dofs,
                             model->interface.count, &parts, err))
        return false;
    Drive drive = stages_drive(model);
    model->choice =
        (ChoiceSizes){.space = model->interface.dim > 2,
                      .unknowns = model->full_dofs,
                      .interface = model->interface.count,
                      .stages = stages_expect(scene, &drive),
                      .parts = parts,
                      .runs = scene->reduction.cache ? fmax(scene->reduction.runs, 1) : 1,
                      .several = model->materials.count > 1,
                      .held = held};
    model->expected = choice_expect(&model->choice);
    return true;
}

static bool reduction_pays(const Model *model)
{
    const Scene *scene = model->scene;
    bool is_asked = scene->reduction.use == REDUCE_AUTO && scene->reduction.decided == REDUCE_AUTO;
    return !is_asked || choice_reduces(&model->choice, &model->expected);
}

// A pushing rod comes from behind: on the leading face it would have to stand inside the block.
static bool check_rod(const Scene *scene, double reach, Error *err)
{
    if (reach > 0.5 && scene->rod.kind == ROD_PUSH)
        return REFUSE(err,
                      "%s: rod.kind: push, but group `%s` is on the leading half of the block, "
                      "which a rod that moves along +x cannot push; let it pull there (rod.kind: "
                      "bonded) or name the trailing face (groups.rod)",
                      scene->path, scene->groups.rod);
    return true;
}

// Said before anything is factored; in space, where it goes up with the fourth power of the cells
// along a side.
static bool check_memory(const Model *model, Error *err)
{
    double bytes = model->is_reduced ? model->expected.bytes_reduced : model->expected.bytes_full;
    double have = model_memory_there();
    if (bytes > have && model->scene->time.scheme != SCHEME_EXPLICIT)
        return REFUSE(err,
                      "%s: %d contact nodes are too many for this computer: a run takes some %.0f "
                      "GB of memory, and there are %.1f; coarser cells at the contact are needed",
                      model->scene->path, model->interface.contact_count, bytes / 1e9, have / 1e9);
    return true;
}

// Of the assembled bulk.
static bool choose(Model *model, Error *err)
{
    if (!model_hold_supports(model, err)) return false;
    if (!expect(model, false, err)) return false;
    model->is_reduced = is_reducible(model) && reduction_pays(model);
    return check_memory(model, err);
}

// The assembled bulk becomes the operator; key: where the cache keeps the shape.
static bool make_operator(Model *model, const char *key, Error *err)
{
    const Interface *interface = &model->interface;
    return choose(model, err) &&
           (model->is_reduced
                ? reduce_bulk(model, key, err)
                : bulk_operator_create(&model->bulk, model->mesh.position, interface->dofs,
                                       interface->count, &model->system, err));
}

// The shape's key, where it can be kept: supports are part of the assembled bulk only.
static bool find_key(Model *model, char key[HASH_TEXT_SIZE], Error *err)
{
    const Scene *scene = model->scene;
    int64_t limit;   // of the cache that is to be used
    key[0] = 0;
    if (scene->reduction.cache && !cache_folder_limit(&limit, err)) return false;
    if (!is_reducible(model) || scene->load.support_count > 0) return true;
    bool done = shape_key(scene, reduction_tolerance(scene), key, err);
    if (done && !key[0] && scene->reduction.cache)
        snprintf(model->cache_note, sizeof model->cache_note,
                 "the mesh file draws on more than its own text: meshed anew");
    return scene_blame(scene, "mesh.file", done, err);
}

// Modes of another mesh: gmsh made this one otherwise than the one that was reduced. Always false.
static bool forget_shape(Model *model, Shape *shape)
{
    shape_destroy(shape);
    reduced_bulk_destroy(&model->reduced);
    model->from_cache = false;
    return false;
}

// A shape and its basis, both from the cache; *found: they were there.
static bool find_shape(Model *model, const char *key, Shape *shape, bool *found, Error *err)
{
    *found = false;
    if (!key[0]) return true;
    if (!shape_cache_load(key, shape, found, model->cache_note, err)) return false;
    if (*found && !basis_cache_load(shape->basis, wants_mesh(model->scene), &model->reduced, found,
                                    model->cache_note, err))
        return false;
    *found = *found && model->reduced.interface_count == shape->interface.count;
    model->from_cache = *found;
    if (!*found) forget_shape(model, shape);
    return true;
}

// What velocities and times are measured with.
static void set_scales(Model *model)
{
    const Scene *scene = model->scene;
    const Material *material = &model->materials.mean;
    double length = model->length;
    model->scales.length = length;
    model->scales.trailing = model->middle - 0.5 * length;
    model->scales.time = length / material_speeds(material).longitudinal +
                         materials_viscous_time(&model->materials);
    model->scales.slip_velocity = scene->rod.velocity > 0 ? scene->rod.velocity
                                                          : scene->friction.critical_velocity;
    // Nothing gives a velocity: that with which the load would deform the block in that time.
    if (!(model->scales.slip_velocity > 0))
        model->scales.slip_velocity = model->scales.load / model->breadth / material->young /
                                      model->scales.time;
}

bool model_forecast(const Scene *scene, Model *model, Error *err)
{
    char key[HASH_TEXT_SIZE];
    Shape shape = {0};
    bool found = false;
    *model = model_of(scene);
    TRY(find_key(model, key, err));
    TRY(find_shape(model, key, &shape, &found, err));
    if (!found || wants_mesh(scene)) TRY(model_read_mesh(model, err));
    if (found)
        TRY(adopt_shape(model, &shape, err) && expect(model, true, err));
    else
        TRY(model_build_bulk(model, err) && choose(model, err));
cleanup:
    shape_destroy(&shape);
    return error_is_clean(err);
}

// Three ways, the shortest that is open: shape and basis from the cache; meshed and assembled, the
// basis from the cache; all made here.
bool model_obtain(const Scene *scene, const StageNotice *notice, Model *model, Error *err)
{
    double started = clock_seconds();
    char key[HASH_TEXT_SIZE];
    Shape shape = {0};
    bool found = false;
    *model = model_of(scene);
    TRY(find_key(model, key, err));
    TRY(find_shape(model, key, &shape, &found, err));
    if (notice && (!found || wants_mesh(scene))) TRY(notice->tell(notice->self, "meshing", err));
    if (!found || wants_mesh(scene)) TRY(model_read_mesh(model, err));
    if (found && wants_mesh(scene) &&
        model->mesh.dim * model->mesh.node_count != model->reduced.full_dofs)
        found = forget_shape(model, &shape);
    if (notice && !found) TRY(notice->tell(notice->self, "reducing", err));
    if (!found) TRY(model_build_bulk(model, err));
    // What a scene may ask of a shape is checked here, wherever the shape comes from.
    TRY(check_rod(scene, found ? shape.sizes.rod_reach : rod_reach(model), err));
    if (found)
        TRY(adopt_shape(model, &shape, err) && expect(model, true, err));
    else
        TRY(make_operator(model, key, err));
    model->system.machine = model_machine(model);
    TRY(model_lay_laws(model, err));
    TRY(model_lay_gaps(model, err));
    set_scales(model);
cleanup:
    shape_destroy(&shape);
    model->seconds_reduce = clock_seconds() - started - model->seconds_mesh;
    return error_is_clean(err);
}
