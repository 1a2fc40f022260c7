// SPDX-License-Identifier: GPL-2.0-or-later
// A region whose numbers are all those of `material` is no region: a scene of one material, however
// it is written, is stepped like one.
#include "model/regions.h"

#include "base/memory.h"
#include "scene/materials.h"

#include <math.h>

_Static_assert(MATERIALS_MAX == SCENE_MATERIALS_MAX + 1, "a material for each region, and one");

// Of a strip's ends and an element's, relative to the block's height: rounding only.
static const double HEIGHT_TOLERANCE = 1e-9;

static bool is_alike(const Material *a, const Material *b)
{
    return a->young == b->young && a->poisson == b->poisson && a->density == b->density &&
           a->eta1 == b->eta1 && a->eta2 == b->eta2;
}

Materials regions_of_scene(const Scene *scene)
{
    bool alike = true;
    Materials made = {.count = 1 + scene->materials.count};
    made.list[0] = (Material){.young = scene->material.young,
                              .poisson = scene->material.poisson,
                              .density = scene->material.density,
                              .eta1 = scene->material.eta1,
                              .eta2 = scene->material.eta2,
                              .plane_strain = scene->material.plane == PLANE_STRAIN};
    for (int32_t i = 0; i < scene->materials.count; i++) {
        const SceneMaterial *region = &scene->materials.region[i];
        Material *one = &made.list[i + 1];
        *one = (Material){.young = scene_material_number(scene, region, MATERIAL_YOUNG),
                          .poisson = scene_material_number(scene, region, MATERIAL_POISSON),
                          .density = scene_material_number(scene, region, MATERIAL_DENSITY),
                          .eta1 = scene_material_number(scene, region, MATERIAL_ETA1),
                          .eta2 = scene_material_number(scene, region, MATERIAL_ETA2),
                          .plane_strain = made.list[0].plane_strain};
        alike = alike && is_alike(one, &made.list[0]);
    }
    if (alike) made.count = 1;
    made.mean = made.list[0];
    return made;
}

// The elements of region i, which no other has. owner: [elements] 1 + region.
static bool claim_elements(const Model *model, int32_t i, uint8_t *owner, Error *err)
{
    const SceneMaterials *named = &model->scene->materials;
    const Mesh *mesh = &model->mesh;
    const char *name = named->region[i].group;
    MeshFile view = {.group_count = mesh->group_count, .groups = mesh->groups};
    const MeshGroup *group = mesh_file_group(&view, mesh->path, name, 2, err);
    if (!group) goto cleanup;
    if (group->blurred)
        FAIL(err, ERROR_INPUT,
             "%s: which elements belong to group '%s' cannot be told: another group has its "
             "elementary number (save the mesh in format 4.1)",
             mesh->path, name);
    for (int32_t k = 0; k < group->element_count; k++) {
        int32_t e = group->elements[k];
        if (owner[e])
            FAIL(err, ERROR_INPUT, "%s: element %lld is in both '%s' and '%s': of which material?",
                 mesh->path, (long long)mesh->element_number[e], named->region[owner[e] - 1].group,
                 name);
        owner[e] = (uint8_t)(i + 1);
    }
cleanup:
    return error_is_clean(err);
}

bool model_mark_regions(Model *model, Error *err)
{
    Mesh *mesh = &model->mesh;
    Materials *materials = &model->materials;
    uint8_t *owner = NULL;
    if (model->scene->materials.count == 0) return true;
    TRY((owner = NEW_ARRAY(uint8_t, mesh->element_count, err)));
    for (int32_t i = 0; i < model->scene->materials.count; i++)
        TRY(scene_blame(model->scene, "materials", claim_elements(model, i, owner, err), err));
    if (materials->count == 1) goto cleanup;
    for (int32_t e = 0; e < mesh->element_count; e++)
        materials->area[owner[e]] += mesh_element_area(mesh, e);
    materials_find_mean(materials);
    mesh->region = owner;
    owner = NULL;
cleanup:
    memory_free(owner);
    return error_is_clean(err);
}

// The regions of the elements that have an edge on a curve.
typedef struct EdgeRegions {
    int32_t first, other;   // the first found; another one, -1: none
} EdgeRegions;

// Only edges that reach between the heights low and high. on: [nodes] of the curve.
static EdgeRegions find_regions(const Mesh *mesh, const uint8_t *on, double low, double high)
{
    EdgeRegions found = {-1, -1};
    for (int32_t e = 0; e < mesh->element_count; e++) {
        double bottom = INFINITY, top = -INFINITY;
        int32_t count = 0;
        for (int32_t a = mesh->first_node[e]; a < mesh->first_node[e + 1]; a++) {
            int32_t node = mesh->element_nodes[a];
            if (!on[node]) continue;
            count++;
            bottom = fmin(bottom, mesh->position[2 * node + 1]);
            top = fmax(top, mesh->position[2 * node + 1]);
        }
        if (count < 2 || top < low || bottom > high) continue;
        if (found.first < 0)
            found.first = mesh_region(mesh, e);
        else if (mesh_region(mesh, e) != found.first)
            found.other = mesh_region(mesh, e);
    }
    return found;
}

static bool look_along(const Mesh *mesh, const int32_t *nodes, int32_t count, double low,
                       double high, EdgeRegions *found, Error *err)
{
    uint8_t *on = NEW_ARRAY(uint8_t, mesh->node_count, err);
    for (int32_t k = 0; on && k < count; k++) on[nodes[k]] = 1;
    if (on) *found = find_regions(mesh, on, low, high);
    memory_free(on);
    return on != NULL;
}

static const char *region_name(const Scene *scene, int32_t region)
{
    return region == 0 ? "material" : scene->materials.region[region - 1].group;
}

bool model_place_regions(Model *model, double low, double high, Error *err)
{
    const Scene *scene = model->scene;
    const Mesh *mesh = &model->mesh;
    const Interface *interface = &model->interface;
    double rounding = HEIGHT_TOLERANCE * model->height;
    EdgeRegions found = {-1, -1};
    MeshCurve rod;
    int32_t pad = 0;   // contact nodes of the first pad
    if (!mesh->region) return true;
    while (pad < interface->contact_count && interface->pad[pad] == interface->pad[0]) pad++;
    TRY(look_along(mesh, interface->node, pad, -INFINITY, INFINITY, &found, err));
    model->contact_region = found.first < 0 ? 0 : found.first;
    if (scene->rod.kind == ROD_NONE) return true;
    TRY(mesh_curve(mesh, scene->groups.rod, &rod, err));
    TRY(look_along(mesh, rod.nodes, rod.node_count, low + rounding, high - rounding, &found, err));
    if (found.other >= 0 && scene->rod.ends == ROD_ENDS_EXACT)
        FAIL(
            err, ERROR_INPUT,
            "%s: the strip from z = %g to %g lies on two materials, `%s` and `%s`: its ends within "
            "cells can be on one only (move rod.height, narrow rod.width, or rod.ends: nodes)",
            scene->path, low, high, region_name(scene, found.first),
            region_name(scene, found.other));
    model->rod_region = found.first < 0 ? 0 : found.first;
cleanup:
    return error_is_clean(err);
}
