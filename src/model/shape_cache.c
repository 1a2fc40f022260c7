// SPDX-License-Identifier: GPL-2.0-or-later
// Whether a scene's shape is known is decided without gmsh: by the bytes of its mesh file, the
// parameters it is given, and the keys of the scene that choose nodes. A .geo that draws on more
// than these (io/mesh/mesh_source) is meshed every time.
//
// What is read is checked against the counts that stand in the file itself (io/cache/store checks
// that the file is whole), and anything that does not fit means that the shape is made anew.
#include "model/shape_cache.h"

#include "base/computation.h"
#include "base/memory.h"
#include "io/mesh/element_faces.h"
#include "io/mesh/mesh_source.h"
#include "model/basis_cache.h"
#include "scene/materials.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

// Zeroed is fine.
void shape_destroy(Shape *shape)
{
    interface_destroy(&shape->interface);
    *shape = (Shape){0};
}

// Never 0: a scene without loads is measured by 1.
double load_reference(const Scene *scene)
{
    double largest = fabs(scene->load.pressure);
    if (largest > 0) return largest;
    for (int32_t k = 0; k < scene->load.traction_count; k++)
        largest =
            fmax(largest, fmax(fabs(scene->load.tractions[k].x), fabs(scene->load.tractions[k].z)));
    return largest > 0 ? largest : 1;
}

// Where the rod and the loads act. Of the loads only their ratios: the basis answers to a unit
// load.
static void hash_boundary(const Scene *scene, Hash *hash)
{
    double reference = load_reference(scene);
    hash_text(hash, scene->groups.top);
    for (int32_t k = 0; k < scene->groups.contact.count; k++)
        hash_text(hash, scene->groups.contact.name[k]);
    hash_text(hash, scene->rod.kind == ROD_NONE ? "no rod" : scene->groups.rod);
    hash_number(hash, scene->rod.height);
    hash_number(hash, scene->rod.width);
    hash_number(hash, scene->rod.breadth);
    hash_number(hash, scene->rod.whole);
    hash_number(hash, scene->rod.ends);
    hash_number(hash, scene->load.pressure / reference);
    for (int32_t k = 0; k < scene->load.traction_count; k++) {
        hash_text(hash, scene->load.tractions[k].group);
        hash_number(hash, scene->load.tractions[k].x / reference);
        hash_number(hash, scene->load.tractions[k].y / reference);
        hash_number(hash, scene->load.tractions[k].z / reference);
    }
}

// A region's numbers over those of `material`, which a basis and the place of the mean depend on.
static void hash_regions(const Scene *scene, Hash *hash)
{
    double eta = scene->material.eta1 + scene->material.eta2;
    const double scales[SCENE_MATERIAL_NUMBERS] = {scene->material.young, 1,
                                                   scene->material.density, eta, eta};
    for (int32_t i = 0; i < scene->materials.count; i++) {
        const SceneMaterial *region = &scene->materials.region[i];
        hash_text(hash, region->group);
        for (int32_t k = 0; k < SCENE_MATERIAL_NUMBERS; k++)
            hash_number(hash, scene_material_number(scene, region, k) / scales[k]);
    }
}

// The lengths are in it, by the mesh's parameters: another length has another interface (x,
// weights) and shares the basis only, which goes by the block's content
// (reduction/reduction_block).
bool shape_key(const Scene *scene, double tolerance, char key[HASH_TEXT_SIZE], Error *err)
{
    key[0] = 0;
    if (!scene->reduction.cache) return true;
    Hash hash = computation_hash_bits();
    bool whole = false;
    double eta = scene->material.eta1 + scene->material.eta2;
    if (!mesh_source_hash(scene->mesh.file, scene->mesh.parameters, scene->mesh.parameter_count,
                          &hash, &whole, err))
        return false;
    hash_boundary(scene, &hash);
    hash_number(&hash, scene->material.poisson);
    hash_number(&hash, scene->material.plane);
    hash_number(&hash, scene->material.eta2 / eta);
    hash_regions(scene, &hash);
    hash_number(&hash, tolerance);
    hash_number(&hash, scene->reduction.use);   // or auto would take what always alone makes
    if (whole) hash_write(&hash, key);
    return true;
}

// Regions that there can be, and an index within 32 bits.
static bool is_possible(const ShapeSizes *sizes)
{
    const RodEnd *end = sizes->rod_end;
    const double region[] = {end[0].region[0], end[0].region[1], end[1].region[0], end[1].region[1],
                             sizes->contact_region};
    for (size_t k = 0; k < sizeof region / sizeof *region; k++)
        if (!(region[k] >= 0 && region[k] < MATERIALS_MAX)) return false;
    return sizes->full_dofs >= 0 && sizes->full_dofs < INT32_MAX && sizes->elements >= 0 &&
           sizes->elements < INT32_MAX;
}

// What a block in the plane has nothing of.
static void archive_across(Interface *interface, Archive *archive)
{
    int32_t rod = interface->rod_count;
    archive_new_numbers(archive, &interface->rod_y, rod);
    archive_new_numbers(archive, &interface->rod_length, rod);
    archive_length(archive, &interface->line_count);
    archive_new_indices(archive, &interface->line, interface->line_count, 0,
                        interface->contact_count);
}

static void archive_faces(ContactFaces *faces, int32_t contact_count, Archive *archive)
{
    archive_length(archive, &faces->count);
    archive_length(archive, &faces->width);
    archive_length(archive, &faces->corner_count);
    archive_require(archive, faces->width <= FACE_NODES_MAX);
    if (archive->failed) return;
    archive_new_indices(archive, &faces->point, faces->count * faces->width, -1,
                        contact_count + faces->corner_count);
    archive_new_numbers(archive, &faces->corner, 2 * (int64_t)faces->corner_count);
}

// dofs: of the mesh.
static void archive_interface(Interface *interface, int32_t dofs, Archive *archive)
{
    bool has_gap = interface->gap != NULL;
    archive_length(archive, &interface->dim);
    archive_length(archive, &interface->contact_count);
    archive_length(archive, &interface->rod_count);
    archive_length(archive, &interface->pad_count);
    archive_require(archive, interface->dim >= 2 && interface->dim <= DIM_MAX);
    if (archive->failed) return;
    int32_t contact = interface->contact_count, rod = interface->rod_count;
    int32_t nodes = dofs / interface->dim;
    interface->count = interface_rod(interface, rod);
    archive_new_indices(archive, &interface->node, contact, 0, nodes);
    archive_new_numbers(archive, &interface->x, contact);
    if (interface->dim > 2) archive_new_numbers(archive, &interface->y, contact);
    archive_new_numbers(archive, &interface->weight, contact);
    archive_flag(archive, &has_gap);
    if (has_gap) archive_new_numbers(archive, &interface->gap, contact);
    archive_new_indices(archive, &interface->pad, contact, 0, interface->pad_count);
    interface->pad_name =
        archive_new(archive, interface->pad_name, interface->pad_count, GROUP_NAME_SIZE);
    for (int32_t k = 0; interface->pad_name && k < interface->pad_count; k++)
        archive_text(archive, interface->pad_name[k], GROUP_NAME_SIZE);
    archive_new_indices(archive, &interface->rod_node, rod, 0, nodes);
    archive_new_numbers(archive, &interface->rod_z, rod);
    archive_new_numbers(archive, &interface->rod_share, rod);
    if (interface->dim > 2) archive_across(interface, archive);
    archive_numbers(archive, interface->rod_face, 2);
    archive_new_indices(archive, &interface->dofs, interface->count, 0, dofs);
    if (interface->dim > 2) archive_faces(&interface->faces, contact, archive);
}

static void archive_shape(void *self, Archive *archive)
{
    Shape *shape = self;
    archive_numbers(archive, &shape->sizes.length, sizeof shape->sizes / sizeof(double));
    archive_require(archive, is_possible(&shape->sizes));
    if (archive->failed) return;
    archive_text(archive, shape->basis, sizeof shape->basis);
    archive_interface(&shape->interface, (int32_t)shape->sizes.full_dofs, archive);
}

bool shape_cache_load(const char *key, Shape *shape, bool *found, char note[CACHE_NOTE_SIZE],
                      Error *err)
{
    *shape = (Shape){0};
    bool done =
        cache_load(&(CacheItem){CACHE_SHAPE, key, archive_shape, shape}, NULL, found, note, err);
    if (!*found) shape_destroy(shape);
    return done;
}

void shape_cache_store(const char *key, const Shape *shape, char note[CACHE_NOTE_SIZE])
{
    Shape same = *shape;
    cache_store(&(CacheItem){CACHE_SHAPE, key, archive_shape, &same}, note);
}
