// SPDX-License-Identifier: GPL-2.0-or-later
// The one place that translates a scene's words on mesh, loads, supports and contact into the
// definitions of the layers below.
#include "model/assemble.h"

#include "base/clock.h"
#include "algebra/dense.h"
#include "fem/floor.h"
#include "model/loads.h"
#include "model/regions.h"
#include "model/scene_mesh.h"

#include <math.h>
#include <stdio.h>

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
    TRY(model_mark_regions(model, err));
cleanup:
    model->seconds_mesh = clock_seconds() - started;
    return error_is_clean(err);
}

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

bool model_lay_bulk(Model *model, Error *err)
{
    const Scene *scene = model->scene;
    double middle = 0, width = 0;
    model_rod_strip(scene, model->height, &middle, &width);
    if (!bulk_create(&model->mesh, &model->bulk, err) || !add_loads(model, err)) return false;
    bool fits = model_lay_branches(model, err);
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
    done = model_place_regions(model, middle - 0.5 * width, middle + 0.5 * width, err);
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
