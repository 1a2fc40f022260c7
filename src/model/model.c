// SPDX-License-Identifier: GPL-2.0-or-later
#include "model/model.h"

#include "base/memory.h"
#include "friction/friction_start.h"
#include "scene/materials.h"

#include <math.h>
#include <string.h>

void model_destroy(Model *model)
{
    bulk_operator_destroy(&model->system);
    reduced_bulk_destroy(&model->reduced);
    interface_destroy(&model->interface);
    bulk_destroy(&model->bulk);
    bulk_destroy(&model->bulk_of_nodes);
    mesh_destroy(&model->mesh);
    memory_free_all(model->friction_nodes, model->laws);
    *model = (Model){0};
}

_Static_assert(MATERIALS_MAX == SCENE_MATERIALS_MAX + 1, "a material for each region, and one");

// Least part of the contact that the contact region must cover, so that a layer, or pads of one
// material, touch the floor and no other material does.
static const double FLOOR_PART = 0.9;

static void set_branches(const Scene *scene, const SceneMaterial *region, Material *material)
{
    const SceneRelaxation *relaxation = scene_material_relaxation(scene, region);
    material->branch_count = relaxation->count;
    for (int32_t k = 0; k < relaxation->count; k++)
        material->branch[k] = (Branch){.time = relaxation->branch[k].time,
                                       .shear = relaxation->branch[k].shear,
                                       .bulk = relaxation->branch[k].bulk};
}

Model model_of(const Scene *scene)
{
    // The scene's `material`, then its regions in their order; areas are not known yet.
    bool alike = true;
    Materials made = {.count = 1 + scene->materials.count};
    Material *first = &made.list[0];
    *first = (Material){.young = scene->material.young,
                        .poisson = scene->material.poisson,
                        .density = scene->material.density,
                        .eta1 = scene->material.eta1,
                        .eta2 = scene->material.eta2,
                        .plane_strain = scene->material.plane == PLANE_STRAIN};
    set_branches(scene, NULL, first);
    for (int32_t i = 0; i < scene->materials.count; i++) {
        const SceneMaterial *region = &scene->materials.region[i];
        Material *one = &made.list[i + 1];
        *one = (Material){.young = scene_material_number(scene, region, MATERIAL_YOUNG),
                          .poisson = scene_material_number(scene, region, MATERIAL_POISSON),
                          .density = scene_material_number(scene, region, MATERIAL_DENSITY),
                          .eta1 = scene_material_number(scene, region, MATERIAL_ETA1),
                          .eta2 = scene_material_number(scene, region, MATERIAL_ETA2),
                          .plane_strain = first->plane_strain};
        set_branches(scene, region, one);
        alike = alike && one->young == first->young && one->poisson == first->poisson &&
                one->density == first->density && one->eta1 == first->eta1 &&
                one->eta2 == first->eta2 && one->branch_count == first->branch_count &&
                memcmp(one->branch, first->branch,
                       (size_t)one->branch_count * sizeof *one->branch) == 0;
    }

    // A scene of one material, however it is written, is stepped as one.
    if (alike) made.count = 1;
    made.mean = made.list[0];
    return (Model){.scene = scene,
                   .materials = made,
                   .friction = friction_everywhere(friction_node(&scene->friction, 1)),
                   .breadth = 1};
}

double model_friction_slip(const Model *model)
{
    double pressure = model->scales.load / (model->length * model->breadth);
    return friction_slip(&model->friction, pressure, model->height, model->materials.mean.young);
}

double model_forgets(const Model *model)
{
    double slowest = INFINITY, speed = model->scales.slip_velocity;
    int32_t count = model->interface.contact_count;
    for (int32_t i = 0; i < count && friction_remembers(&model->friction, count); i++)
        slowest = fmin(slowest, friction_forgets(friction_at(&model->friction, i), speed));
    return slowest;
}

double model_slip_per_mu(const Model *model)
{
    Friction one = friction_everywhere(friction_constant(1));
    double pressure = model->scales.load / (model->length * model->breadth);
    return friction_slip(&one, pressure, model->height, model->materials.mean.young);
}

double model_crossing(const Model *model)
{
    const Materials *materials = &model->materials;
    const Material *layer = &materials->list[model->contact_region];

    // Mean height of the layer or the pads that the block stands on, where these have a material of
    // their own; else 0, as where they stand beside others.
    double touching = 0, height = 0, width = materials->width[model->contact_region];
    for (int32_t i = 0; i < model->interface.contact_count; i++)
        touching += model->interface.weight[i];
    if (materials->count > 1 && width > 0 && !(width < FLOOR_PART * touching))
        height = materials->area[model->contact_region] / width;
    return fmax(model->length / materials_slip_speed(materials),
                height / material_slip_speed(layer));
}

double model_settling_time(const Model *model)
{
    return model->scales.time + materials_relaxation_time(&model->materials);
}

double model_stiffening(const Model *model)
{
    return material_at_once(&model->materials.mean).young / model->materials.mean.young;
}

// Slip times E L/H is the drop (mu_S - mu_K) F_N.
double model_machine_yield(const Model *model)
{
    double stiffness = model_machine(model).stiffness;
    double block = model->materials.mean.young * model->length * model->breadth / model->height;
    return stiffness > 0 ? model_friction_slip(model) * block / stiffness : 0;
}

// 4 mu (lambda + mu)/(lambda + 2 mu) of sigma = D eps: what a half-plane sets against a pressure.
static double half_plane(Moduli moduli)
{
    double axial = moduli_axial(moduli), shear = moduli_shear(moduli);
    return axial > 0 ? 4 * shear * (axial - shear) / axial : 0;
}

static RodGround ground_of(const Model *model, int32_t region)
{
    const Material *face = &model->materials.list[region];
    return (RodGround){half_plane(material_elastic(face)), half_plane(material_viscous(face))};
}

bool model_build_rod(const Model *model, RodKind kind, Rod *rod, Error *err)
{
    RodGround ground[2];
    for (int k = 0; k < 2; k++) {
        // Where materials meet within what the strip's end covers, the ground yields as their
        // pieces do one after the other, so that the force changes without a jump as the strip is
        // moved over the joint.
        const RodEnd *end = &model->rod_end[k];
        RodGround below = ground_of(model, end->region[0]);
        RodGround above = ground_of(model, end->region[1]);
        double part = end->below;
        ground[k] = below;
        if (end->region[0] == end->region[1]) continue;
        double viscous = part / below.viscosity + (1 - part) / above.viscosity;
        ground[k].modulus = 1 / (part / below.modulus + (1 - part) / above.modulus);
        ground[k].viscosity = isfinite(viscous) ? 1 / viscous : 0;
    }
    if (!rod_build(&model->interface, kind, 0, rod, err)) return false;
    rod->stiffness = model_machine(model).stiffness;
    rod_soften(&model->interface, ground, rod);
    return true;
}

Machine model_machine(const Model *model)
{
    const Interface *interface = &model->interface;
    return (Machine){.stiffness = interface->rod_count > 0 ? model->machine_stiffness : 0,
                     .first = interface_rod(interface, 0)};
}

void model_rod_strip(const Scene *scene, double height, double *middle, double *width)
{
    static const double standard_middle = 0.5, standard_width = 0.1;   // of H
    *middle = scene->rod.height > 0 ? scene->rod.height : standard_middle * height;
    *width = scene->rod.width > 0 ? scene->rod.width : standard_width * height;
}
