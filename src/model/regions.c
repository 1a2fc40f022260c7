// SPDX-License-Identifier: GPL-2.0-or-later
#include "model/regions.h"

#include "base/memory.h"
#include "fem/element_group.h"

#include <math.h>

bool model_mark_regions(Model *model, Error *err)
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

// A branch is a viscosity where rate * time stays below this: its modulus is off by this part then.
static const double FOLDED = 1e-3;

bool model_lay_branches(Model *model, Error *err)
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

bool model_place_regions(Model *model, double low, double high, Error *err)
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
