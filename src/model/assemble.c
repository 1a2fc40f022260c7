// SPDX-License-Identifier: GPL-2.0-or-later
// The one place that translates a scene's words on mesh, loads, supports and contact into the
// definitions of the layers below.
#include "model/assemble.h"

#include "algebra/dense.h"
#include "base/clock.h"
#include "base/memory.h"
#include "fem/element_group.h"
#include "fem/floor.h"
#include "model/loads.h"
#include "model/scene_mesh.h"

#include <math.h>
#include <stdio.h>

// --- mesh and materials --------------------------------------------------------------------------

// Marks the elements of model->mesh with their materials, the physical surfaces that the map
// `materials` of the scene names, and measures these; groups those that are nearly incompressible
// (fem/element_group). ERROR_INPUT: no such surface, or two that share an element.
static bool mark_regions(Model *model, Error *err)
{
    const SceneMaterials *named = &model->scene->materials;
    Materials *materials = &model->materials;
    Mesh *mesh = &model->mesh;
    uint8_t is_mean[MATERIALS_MAX];   // [materials] 1: its elements take the mean of their strain
    uint8_t *owner = NULL;   // [elements] 1 + region; owned

    // The elements of each region, which no other has.
    MeshFile view = {.group_count = mesh->group_count, .groups = mesh->groups};
    if (named->count > 0) TRY(owner = NEW_ARRAY(uint8_t, mesh->element_count, err));
    for (int32_t i = 0; i < named->count; i++) {
        const char *name = named->region[i].group;
        const MeshGroup *group = mesh_file_group(&view, mesh->path, name, mesh->dim, err);
        bool done = group != NULL;
        for (int32_t k = 0; done && k < group->element_count; k++) {
            int32_t e = group->elements[k];
            if (owner[e])
                done = REFUSE(err, "%s: element %lld is in both '%s' and '%s': of which material?",
                              mesh->path, (long long)mesh->element_number[e],
                              named->region[owner[e] - 1].group, name);
            else
                owner[e] = (uint8_t)(i + 1);
        }
        TRY(scene_blame(model->scene, "materials", done, err));
    }

    // Several materials: their areas, their mean, and the mean width of each one's elements.
    if (named->count > 0 && materials->count > 1) {
        for (int32_t e = 0; e < mesh->element_count; e++) {
            double area = mesh_element_area(mesh, e);
            materials->area[owner[e]] += area;
            if (mesh_element_in_base(mesh, e)) materials->base_area[owner[e]] += area;
        }
        materials_find_mean(materials);
        mesh->region = owner;
        owner = NULL;
        for (int32_t k = 0; k < materials->count; k++) {
            double low = INFINITY, high = -INFINITY;
            for (int32_t e = 0; e < mesh->element_count; e++) {
                if (mesh_region(mesh, e) != k) continue;
                for (int32_t a = mesh->first_node[e]; a < mesh->first_node[e + 1]; a++) {
                    double z = mesh_height(mesh, mesh->element_nodes[a]);
                    low = fmin(low, z);
                    high = fmax(high, z);
                }
            }
            materials->width[k] = high > low ? materials->area[k] / (high - low) : 0;
        }
    }

    // A mean over one TET4 is what it has already, and a mean over several was not found.
    for (int32_t k = 0; k < materials->count; k++)
        is_mean[k] = material_resists_area(&materials->list[k]);
    for (int32_t e = 0; e < mesh->element_count; e++)
        if (mesh->kind[e] == ELEMENT_TET4 && is_mean[mesh_region(mesh, e)])
            FAIL(err, ERROR_INPUT,
                 "%s: TET4 lock in a material whose volume resists so much more than its shape; "
                 "take hexahedra, wedges or order 2",
                 mesh->path);
    TRY(element_groups_find(is_mean, mesh, err));
cleanup:
    memory_free(owner);
    return error_is_clean(err);
}

// This is the slowest part of a small run where gmsh has to make the mesh.
bool model_read_mesh(const ChildWatch *watch, Model *model, Error *err)
{
    const Scene *scene = model->scene;
    double started = clock_seconds();
    TRY(scene_mesh_read(scene, watch, &model->mesh, &model->mesh_origin, err));
    if (model->mesh_origin == MESH_OF_OTHER_FILES && scene->reduction.cache)
        snprintf(model->cache_note, sizeof model->cache_note,
                 "the mesh file draws on more than its own text: meshed anew");
    const Mesh *mesh = &model->mesh;
    model->length = mesh->x_max - mesh->x_min;
    model->middle = 0.5 * (mesh->x_min + mesh->x_max);
    model->height = mesh->z_max - mesh->z_min;
    if (mesh->dim > 2) model->breadth = mesh->y_max - mesh->y_min;

    // The key that the mesh's dimension does not allow. Where several are wrong, the last one found
    // is named.
    const char *wrong = NULL;
    if (mesh->dim > 2) {
        // A material in space is neither in plane stress nor in plane strain: lambda is that of
        // plane strain, which a material that keeps its volume has none of.
        Materials *materials = &model->materials;
        for (int32_t k = 0; k < materials->count; k++) {
            materials->list[k].plane_strain = true;
            if (!(materials->list[k].poisson < 0.5)) wrong = "material.poisson";
        }
        materials->mean.plane_strain = true;
    } else {
        for (int32_t k = 0; k < scene->load.support_count; k++)
            if (scene->load.supports[k].y) wrong = "load.supports";
        for (int32_t k = 0; k < scene->load.traction_count; k++)
            if (scene->load.tractions[k].y != 0) wrong = "load.tractions";
        if (scene->rod.breadth > 0) wrong = "rod.breadth";
    }
    if (wrong) {
        error_set(err, ERROR_INPUT, __FILE__, __LINE__,
                  mesh->dim > 2 ? "a mesh in space needs Poisson's ratios below 0.5"
                                : "the mesh is in the plane: there is no y");
        TRY(scene_blame(scene, wrong, false, err));
    }

    // Loads and the machine's stiffness, which a scene may give as forces, are those of this mesh.
    TRY(scene_check_thickness(scene, mesh, err));
    TRY(scene_pressure(scene, mesh, &model->pressure, err));
    for (int32_t k = 0; k < scene->load.traction_count; k++)
        TRY(scene_traction(scene, mesh, k, model->tractions[k], err));
    model->machine_stiffness = scene_machine_stiffness(scene, mesh, model->breadth);
    TRY(mark_regions(model, err));
cleanup:
    model->seconds_mesh = clock_seconds() - started;
    return error_is_clean(err);
}

// --- loads and interface ------------------------------------------------------------------------

// The pressure, else the largest traction. Never 0: a scene without loads is measured by 1.
double load_reference(const Model *model)
{
    const Scene *scene = model->scene;
    double largest = fabs(model->pressure);
    if (largest > 0) return largest;
    for (int32_t k = 0; k < scene->load.traction_count; k++) {
        const double *traction = model->tractions[k];
        largest = fmax(largest, fmax(fabs(traction[0]), fabs(traction[model->mesh.dim - 1])));
    }
    return largest > 0 ? largest : 1;
}

// Pressure and tractions onto the bulk's load, first per unit of load_reference(): so what the
// cache keeps of them has the same bits whichever pressure asked first. F_N, the resultant towards
// the plane of those on the block, becomes the force that others are measured with.
static bool add_loads(Model *model, Error *err)
{
    const Scene *scene = model->scene;
    Bulk *bulk = &model->bulk;
    MeshBoundary boundary;
    double reference = load_reference(model), unit = 0;
    int32_t up = bulk->dim - 1;
    if (model->pressure != 0) {
        MeshPlace traction = {0};
        traction[up] = -model->pressure / reference;
        bool found = mesh_boundary(&model->mesh, scene->groups.top, &boundary, err);
        if (!scene_blame(scene, "groups.top", found, err)) return false;
        bulk_add_traction(&model->mesh, &boundary, traction, bulk);
    }
    for (int32_t k = 0; k < scene->load.traction_count; k++) {
        const char *group = scene->load.tractions[k].group;
        MeshPlace traction = {0};
        for (int32_t axis = 0; axis <= up; axis++)
            traction[axis] = model->tractions[k][axis] / reference;
        bool found = mesh_boundary(&model->mesh, group, &boundary, err);
        if (!scene_blame(scene, "load.tractions", found, err)) return false;
        bulk_add_traction(&model->mesh, &boundary, traction, bulk);
    }
    for (int32_t dof = up; dof < bulk->dof_count; dof += bulk->dim)
        unit -= bulk->in_base && bulk->in_base[dof] ? 0 : bulk->load[dof];
    model->unit_load.size = dense_max_abs(bulk->load, bulk->dof_count);
    model->unit_load.resultant = unit;
    for (int32_t dof = 0; dof < bulk->dof_count; dof++) bulk->load[dof] *= reference;

    // A block that is held needs no load, and a block that flies towards the plane has its
    // momentum. Look for a support on the block; a group that is not there is told later.
    for (int32_t k = 0; k < scene->load.support_count && !model->block_is_held; k++) {
        Error ignored = {0};
        bool there =
            mesh_boundary(&model->mesh, scene->load.supports[k].group, &boundary, &ignored);
        model->block_is_held = !there;
        for (int32_t i = 0; there && i < boundary.node_count; i++)
            if (!mesh_in_base(&model->mesh, boundary.nodes[i])) model->block_is_held = true;
    }
    double load = unit * reference;
    if (!(load > 0) && (model->block_is_held || scene->start.velocity_z < 0)) {
        // A force to measure by where no load presses: the impact's, the stress rho c_L v over the
        // floor, or the loads' size.
        const Material *material = &model->materials.mean;
        double impedance = material->density * material_speeds(material).longitudinal;
        double floor = model->length * model->breadth;
        double impact = impedance * fabs(scene->start.velocity_z) * floor;
        load = impact > 0 ? impact : load < 0 ? -load : material->young * floor;
    }
    if (!(load > 0))
        return REFUSE(
            err,
            "%s: the loads do not press the block onto the plane (their resultant along -z is %g)",
            scene->path, load);
    model->scales.load = load;
    return true;
}

// A branch is a viscosity where rate * time stays below this: its modulus is off by this part then.
static const double FOLDED = 1e-3;

// Fills the bulk's spectrum. What relaxes so fast that not even waves within an element follow is
// made a viscosity (model->folded_time).
static bool lay_branches(Model *model, Error *err)
{
    Spectrum *spectrum = &model->bulk.spectrum;
    Materials *materials = &model->materials;
    const Mesh *mesh = &model->mesh;
    double folded = 0, area = 0;
    if (!spectrum_find(materials, mesh->dim, spectrum, err)) return false;
    if (spectrum->count == 0) return true;
    for (int32_t e = 0; e < mesh->element_count; e++) area += mesh_element_area(mesh, e);
    double size = pow(area / mesh->element_count, 1.0 / mesh->dim);   // of an element
    for (int32_t k = 0; k < spectrum->count; k++) {
        // The rate of the fastest wave within an element, c/h, if what relaxes within `time` has
        // relaxed.
        double time = spectrum->time[k], fastest = 0;
        for (int32_t m = 0; m < materials->count; m++) {
            Material slow = materials->list[m];
            int32_t kept = 0;
            if (!materials_use(materials, m)) continue;
            for (int32_t i = 0; i < slow.branch_count; i++)
                if (slow.branch[i].time > time) slow.branch[kept++] = slow.branch[i];
            slow.branch_count = kept;
            fastest = fmax(fastest, material_slip_speed(&slow));
        }
        if (time > folded && time * (fastest / size) < FOLDED) folded = time;
    }
    if (folded == 0 || !spectrum_fold(folded, materials, spectrum)) return true;
    model->folded_time = folded;
    materials_find_mean(materials);
    return true;
}

// The material of the first element that has a face on a boundary, at the height *z (NULL: at any);
// -1: none has. on: [nodes] of the boundary.
static int32_t find_region(const Mesh *mesh, const uint8_t *on, const double *z)
{
    for (int32_t e = 0; e < mesh->element_count; e++) {
        double bottom = INFINITY, top = -INFINITY;
        int32_t count = 0;
        for (int32_t a = mesh->first_node[e]; a < mesh->first_node[e + 1]; a++) {
            int32_t node = mesh->element_nodes[a];
            if (!on[node]) continue;
            count++;
            bottom = fmin(bottom, mesh_height(mesh, node));
            top = fmax(top, mesh_height(mesh, node));
        }
        if (count >= mesh->dim && (!z || (bottom <= *z && *z <= top))) return mesh_region(mesh, e);
    }
    return -1;
}

// [nodes of the mesh] 1 for those listed; the caller's to free. NULL: memory is short.
static uint8_t *mark_nodes(const Mesh *mesh, const int32_t *nodes, int32_t count, Error *err)
{
    uint8_t *on = NEW_ARRAY(uint8_t, mesh->node_count, err);
    for (int32_t k = 0; on && k < count; k++) on[nodes[k]] = 1;
    return on;
}

// Rod node j, at an end of the strip from low to high, with its tributary part of the face half way
// to the nodes beside it. on: [nodes] of the face.
static RodEnd find_end(const Model *model, const MeshBoundary *rod, const uint8_t *on, int32_t j,
                       double low, double high)
{
    const Mesh *mesh = &model->mesh;
    double z = model->interface.rod_z[j], under = -INFINITY, over = INFINITY;
    for (int32_t k = 0; k < rod->node_count; k++) {
        double other = mesh_height(mesh, rod->nodes[k]);
        if (other < z) under = fmax(under, other);
        if (other > z) over = fmin(over, other);
    }
    low = fmin(fmax(low, isfinite(under) ? 0.5 * (under + z) : z), z);
    high = fmax(fmin(high, isfinite(over) ? 0.5 * (z + over) : z), z);
    double inside[2] = {0.5 * (low + z), 0.5 * (z + high)};
    int32_t below = find_region(mesh, on, &inside[0]), above = find_region(mesh, on, &inside[1]);
    if (!(low < z)) below = above;
    if (!(high > z)) above = below;
    return (RodEnd){.region = {below > 0 ? below : 0, above > 0 ? above : 0},
                    .below = high > low ? (z - low) / (high - low) : 0};
}

// Sets the materials that the contact and the ends of the rod's strip, from low to high, lie on.
static bool place_regions(Model *model, double low, double high, Error *err)
{
    const Scene *scene = model->scene;
    const Mesh *mesh = &model->mesh;
    const Interface *interface = &model->interface;
    uint8_t *on_pad = NULL, *on_floor = NULL, *on_contact = NULL, *on_rod = NULL;
    MeshBoundary rod;
    int32_t pad = 0;   // contact nodes of the first pad
    model->on_contact[0] = !mesh->region;
    if (!mesh->region) return true;
    while (pad < interface->contact_count && interface->pad[pad] == interface->pad[0]) pad++;
    TRY((on_pad = mark_nodes(mesh, interface->node, pad, err)));
    model->contact_region = find_region(mesh, on_pad, NULL);
    if (model->contact_region < 0) model->contact_region = 0;
    if (mesh->is_base) {
        TRY((on_floor =
                 mark_nodes(mesh, mesh->floor.node, mesh->floor.start[mesh->node_count], err)));
        model->floor_region = find_region(mesh, on_floor, NULL);
        if (model->floor_region < 0) model->floor_region = 0;
    }
    TRY((on_contact = mark_nodes(mesh, interface->node, interface->contact_count, err)));
    for (int32_t e = 0; e < mesh->element_count; e++) {
        int32_t count = 0;
        for (int32_t a = mesh->first_node[e]; a < mesh->first_node[e + 1]; a++)
            count += on_contact[mesh->element_nodes[a]];
        if (count >= mesh->dim) model->on_contact[mesh_region(mesh, e)] = true;
    }
    if (scene->rod.kind == ROD_NONE) goto cleanup;
    TRY(mesh_boundary(mesh, scene->groups.rod, &rod, err));
    TRY((on_rod = mark_nodes(mesh, rod.nodes, rod.node_count, err)));
    model->rod_end[0] = find_end(model, &rod, on_rod, 0, low, high);
    model->rod_end[1] = find_end(model, &rod, on_rod, interface->rod_count - 1, low, high);
cleanup:
    memory_free_all(on_pad, on_floor, on_contact, on_rod);
    return error_is_clean(err);
}

bool model_lay_bulk(Model *model, Error *err)
{
    const Scene *scene = model->scene;
    double middle = 0, width = 0;
    model_rod_strip(scene, model->height, &middle, &width);
    if (!bulk_create(&model->mesh, &model->bulk, err) || !add_loads(model, err)) return false;
    bool fits = lay_branches(model, err);
    if (!scene_blame(scene, "material.relaxation", fits, err)) return false;
    bool found = floor_find(scene->groups.contact.name, scene->groups.contact.count,
                            scene->groups.floor, &model->mesh, err);
    if (!scene_blame(scene, "groups.floor", found, err)) return false;
    floor_gather(&model->mesh, model->bulk.load);
    InterfaceDef def = {.contact_name_count = scene->groups.contact.count,
                        .contact_names = scene->groups.contact.name,
                        .has_rod = scene->rod.kind != ROD_NONE,
                        .rod_name = scene->groups.rod,
                        .rod_height = middle,
                        .rod_width = width,
                        .rod_breadth = scene->rod.breadth,
                        .rod_whole = scene->rod.whole,
                        .rod_in_part = scene->rod.ends == ROD_ENDS_EXACT};
    const Interface *interface = &model->interface;
    bool done = interface_build(&model->mesh, &def, &model->interface, err);
    const char *last = interface->rod_node             ? "rod.height"
                       : interface->contact_count == 0 ? "groups.contact"
                                                       : "groups.rod";
    if (!scene_blame(scene, last, done, err)) return false;
    done = place_regions(model, middle - 0.5 * width, middle + 0.5 * width, err);
    return scene_blame(scene, "materials", done, err);
}

bool model_hold_supports(Model *model, Error *err)
{
    enum { MOTIONS_MAX = DIM_MAX * (DIM_MAX + 1) / 2 };
    static const double FREE = 1e-12;   // of the largest
    const Scene *scene = model->scene;
    const Mesh *mesh = &model->mesh;
    Bulk *bulk = &model->bulk;
    int32_t dim = mesh->dim;

    // The base first: an unknown of a contact node over a base is its jump, which is 0 where the
    // floor under the node is held, too. Else the node is left to its neighbours, as a rod leaves
    // it to the floor.
    for (int32_t pass = 0; pass < 2; pass++)
        for (int32_t k = 0; k < scene->load.support_count; k++) {
            const SceneSupport *support = &scene->load.supports[k];
            MeshBoundary boundary;
            bool found = mesh_boundary(mesh, support->group, &boundary, err);
            if (!scene_blame(scene, "load.supports", found, err)) return false;
            const bool along[] = {support->x, dim > 2 ? support->y : support->z, support->z};
            for (int32_t i = 0; i < boundary.node_count; i++) {
                int32_t node = boundary.nodes[i], end = floor_end(&mesh->floor, node);
                if (mesh_in_base(mesh, node) != (pass == 0)) continue;
                for (int32_t d = 0; d < dim; d++) {
                    if (!along[d]) continue;
                    bool floor_holds = true;
                    for (int32_t l = floor_start(&mesh->floor, node); l < end; l++)
                        floor_holds = floor_holds &&
                                      bulk->held[node_dof(dim, mesh->floor.node[l], d)];
                    if (floor_holds) bulk_hold(node_dof(dim, node, d), bulk);
                }
            }
        }
    if (!mesh->is_base) return true;

    // Rigid motions of the base that supports, or the rod, leave free are singular values of what
    // they hold.
    int32_t motions = rigid_count(dim);
    double gram[MOTIONS_MAX * MOTIONS_MAX] = {0}, values[MOTIONS_MAX];
    double work[DENSE_EIGEN_WORK(MOTIONS_MAX)], motion[MOTIONS_MAX];
    for (int32_t dof = 0; dof < bulk->dof_count; dof++) {
        int32_t node = dof_node(dim, dof);
        bool held = bulk->held[dof];
        for (int32_t j = 0; j < model->interface.rod_count && !held; j++)
            held = model->interface.rod_node[j] == node && dof_axis(dim, dof) == 0;
        if (!bulk->in_base[dof] || !held) continue;
        MeshPlace place = {(mesh_place(mesh, node)[0] - model->middle) / model->length};
        for (int32_t d = 1; d < dim; d++) place[d] = mesh_place(mesh, node)[d] / model->length;
        for (int32_t k = 0; k < motions; k++)
            motion[k] = rigid_motion(dim, k, place, dof_axis(dim, dof));
        for (int32_t k = 0; k < motions; k++)
            for (int32_t l = 0; l < motions; l++) gram[k * motions + l] += motion[k] * motion[l];
    }
    if (dense_eigen(gram, motions, values, work) && values[0] > FREE * values[motions - 1])
        return true;
    return REFUSE(err,
                  "%s: the base can move freely: hold it, as by `load: {supports: [{group: bottom, "
                  "x: true, %sz: true}]}`",
                  scene->path, dim > 2 ? "y: true, " : "");
}
