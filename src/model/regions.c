// SPDX-License-Identifier: GPL-2.0-or-later
#include "model/regions.h"

#include "base/memory.h"
#include "bulk/element_group.h"

#include <math.h>

// Of a strip's ends and an element's, relative to the block's height: rounding only.
static const double HEIGHT_TOLERANCE = 1e-9;

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

static bool mark_materials(Model *model, Error *err)
{
    Mesh *mesh = &model->mesh;
    Materials *materials = &model->materials;
    uint8_t *owner = NEW_ARRAY(uint8_t, mesh->element_count, err);
    if (!owner) goto cleanup;
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

bool model_mark_regions(Model *model, Error *err)
{
    uint8_t is_mean[MATERIALS_MAX];
    if (model->scene->materials.count > 0 && !mark_materials(model, err)) return false;
    for (int32_t k = 0; k < model->materials.count; k++)
        is_mean[k] = material_resists_area(&model->materials.list[k]);
    return element_groups_find(is_mean, &model->mesh, err);
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

// [nodes of the mesh] 1 for those listed; the caller's to free. NULL: memory is short.
static uint8_t *mark_nodes(const Mesh *mesh, const int32_t *nodes, int32_t count, Error *err)
{
    uint8_t *on = NEW_ARRAY(uint8_t, mesh->node_count, err);
    for (int32_t k = 0; on && k < count; k++) on[nodes[k]] = 1;
    return on;
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
    EdgeRegions found;
    uint8_t *on_pad = NULL, *on_rod = NULL;
    MeshCurve rod;
    int32_t pad = 0;   // contact nodes of the first pad
    if (!mesh->region) return true;
    while (pad < interface->contact_count && interface->pad[pad] == interface->pad[0]) pad++;
    TRY((on_pad = mark_nodes(mesh, interface->node, pad, err)));
    found = find_regions(mesh, on_pad, -INFINITY, INFINITY);
    model->contact_region = found.first < 0 ? 0 : found.first;
    if (scene->rod.kind == ROD_NONE) goto cleanup;
    TRY(mesh_curve(mesh, scene->groups.rod, &rod, err));
    TRY((on_rod = mark_nodes(mesh, rod.nodes, rod.node_count, err)));
    found = find_regions(mesh, on_rod, low + rounding, high - rounding);
    if (found.other >= 0 && scene->rod.ends == ROD_ENDS_EXACT)
        FAIL(
            err, ERROR_INPUT,
            "%s: the strip from z = %g to %g lies on two materials, `%s` and `%s`: its ends within "
            "cells can be on one only (move rod.height, narrow rod.width, or rod.ends: nodes)",
            scene->path, low, high, region_name(scene, found.first),
            region_name(scene, found.other));
    model->rod_region = found.first < 0 ? 0 : found.first;
cleanup:
    memory_free(on_pad);
    memory_free(on_rod);
    return error_is_clean(err);
}
