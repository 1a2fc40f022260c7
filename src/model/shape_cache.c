// SPDX-License-Identifier: GPL-2.0-or-later
// Whether a scene's shape is known is decided without gmsh: by the bytes of its mesh file, the
// parameters it is given, and the keys of the scene that choose nodes. A .geo that draws on more
// than these (io/mesh/mesh_source) is meshed every time.
//
// What is read is checked against the counts that stand in the file itself (io/cache/cache_file
// checks that the file is whole), and anything that does not fit means that the shape is made anew.
#include "model/shape_cache.h"

#include "base/computation.h"
#include "base/memory.h"
#include "io/cache/cache_file.h"
#include "io/mesh/mesh_source.h"
#include "model/basis_cache.h"
#include "scene/materials.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { COUNTS = 5 };   // contact and rod nodes, pads, gaps, unknowns of a contact node

// Names travel as the bytes of doubles, filled up with zeros.
enum {
    NAME_NUMBERS = GROUP_NAME_SIZE / sizeof(double),
    BASIS_NUMBERS = HASH_TEXT_SIZE / sizeof(double) + 1
};

// Zeroed is fine.
void shape_destroy(Shape *shape)
{
    interface_destroy(&shape->interface);
    memory_free(shape->rotation);
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
    hash_number(hash, scene->rod.ends);
    hash_number(hash, scene->load.pressure / reference);
    for (int32_t k = 0; k < scene->load.traction_count; k++) {
        hash_text(hash, scene->load.tractions[k].group);
        hash_number(hash, scene->load.tractions[k].x / reference);
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
    TRY(mesh_source_hash(scene->mesh.file, scene->mesh.parameters, scene->mesh.parameter_count,
                         &hash, &whole, err));
    hash_boundary(scene, &hash);
    hash_number(&hash, scene->material.poisson);
    hash_number(&hash, scene->material.plane);
    hash_number(&hash, scene->material.eta2 / eta);
    hash_regions(scene, &hash);
    hash_number(&hash, tolerance);
    hash_number(&hash, scene->reduction.use);   // or auto would take what always alone makes
    if (whole) hash_write(&hash, key);
cleanup:
    return error_is_clean(err);
}

// Indices travel as doubles: exact up to 2^53. limit: what they are below.
static bool read_indices(const CacheFile *file, const char *name, int32_t count, double limit,
                         int32_t **out, Error *err)
{
    if (!cache_file_array(file, name, count)) return false;
    *out = NEW_ARRAY(int32_t, count, err);
    return *out && cache_file_whole(file, name, count, limit, *out);
}

// Copies: the file's bytes go when it is closed. false without an error: not there, or not so long.
static bool read_numbers(const CacheFile *file, const char *name, int64_t count, double **out,
                         Error *err)
{
    const double *values = cache_file_array(file, name, count);
    if (!values) return false;
    *out = NEW_ARRAY(double, count, err);
    if (*out) memcpy(*out, values, (size_t)count * sizeof(double));
    return *out != NULL;
}

// A name that fills its place would have no end: the last byte is set whatever the file says.
static bool read_names(const CacheFile *file, Interface *interface, Error *err)
{
    int64_t count = interface->pad_count;
    const double *values = cache_file_array(file, "pad_name", count * NAME_NUMBERS);
    if (!values) return false;
    interface->pad_name = memory_array(count, GROUP_NAME_SIZE, err);
    if (!interface->pad_name) return false;
    memcpy(interface->pad_name, values, (size_t)count * GROUP_NAME_SIZE);
    for (int64_t k = 0; k < count; k++) interface->pad_name[k][GROUP_NAME_SIZE - 1] = 0;
    return true;
}

// false without an error: an array is missing or of another length.
static bool read_shape(const CacheFile *file, Shape *shape, Error *err)
{
    int32_t counts[COUNTS];
    const double *sizes = cache_file_array(file, "sizes", sizeof(ShapeSizes) / sizeof(double));
    const double *basis = cache_file_array(file, "basis", BASIS_NUMBERS);
    const double *face = cache_file_array(file, "rod_face", 2);
    if (!cache_file_whole(file, "counts", COUNTS, CACHE_COUNT_LIMIT, counts)) return false;
    if (!sizes || !basis || !face) return false;
    memcpy(&shape->sizes, sizes, sizeof shape->sizes);
    double dofs = shape->sizes.full_dofs, nodes = dofs / fmax(counts[4], 1);
    if (!(dofs < INT32_MAX && shape->sizes.elements >= 0 && shape->sizes.elements < INT32_MAX))
        return false;
    const RodEnd *end = shape->sizes.rod_end;
    const double region[] = {end[0].region[0], end[0].region[1], end[1].region[0], end[1].region[1],
                             shape->sizes.contact_region};
    for (size_t k = 0; k < sizeof region / sizeof *region; k++)
        if (!(region[k] >= 0 && region[k] < MATERIALS_MAX)) return false;
    memcpy(shape->basis, basis, HASH_TEXT_SIZE);
    shape->basis[HASH_TEXT_SIZE - 1] = 0;
    Interface *interface = &shape->interface;
    interface->dim = counts[4];
    interface->contact_count = counts[0];
    interface->rod_count = counts[1];
    interface->pad_count = counts[2];
    interface->count = interface_rod(interface, interface->rod_count);
    memcpy(interface->rod_face, face, sizeof interface->rod_face);
    return read_indices(file, "node", interface->contact_count, nodes, &interface->node, err) &&
           read_numbers(file, "x", interface->contact_count, &interface->x, err) &&
           read_numbers(file, "weight", interface->contact_count, &interface->weight, err) &&
           read_indices(file, "pad", interface->contact_count, counts[2], &interface->pad, err) &&
           read_names(file, interface, err) &&
           (counts[3] == 0 || (counts[3] == interface->contact_count &&
                               read_numbers(file, "gap", counts[3], &interface->gap, err))) &&
           read_indices(file, "rod_node", interface->rod_count, nodes, &interface->rod_node, err) &&
           read_numbers(file, "rod_z", interface->rod_count, &interface->rod_z, err) &&
           read_numbers(file, "rod_share", interface->rod_count, &interface->rod_share, err) &&
           read_indices(file, "dofs", interface->count, dofs, &interface->dofs, err) &&
           read_numbers(file, "rotation", interface->count, &shape->rotation, err);
}

// A shape that is not valid is no error: found is false and `note` says why.
bool shape_cache_load(const char *key, Shape *shape, bool *found, char note[CACHE_NOTE_SIZE],
                      Error *err)
{
    char path[CACHE_PATH_SIZE], reason[CACHE_REASON_SIZE] = "";
    CacheFile file = {0};
    *shape = (Shape){0};
    *found = false;
    if (!key[0] || !cache_file_path(key, "shape", path)) goto cleanup;
    TRY(cache_file_read(path, key, &file, found, reason, err));
    if (*found && !read_shape(&file, shape, err)) {
        *found = false;
        snprintf(reason, sizeof reason, "an array is missing");
    }
    if (reason[0]) snprintf(note, CACHE_NOTE_SIZE, "a cached shape is not used: %s", reason);
cleanup:
    cache_file_destroy(&file);
    if (!*found) shape_destroy(shape);
    return error_is_clean(err);
}

static CacheArray list_numbers(const char *name, const double *values, int64_t count)
{
    CacheArray array = {.count = count, .values = values};
    snprintf(array.name, sizeof array.name, "%s", name);
    return array;
}

// `copy` [count] holds the numbers until the file is written.
static CacheArray list_indices(const char *name, const int32_t *values, int32_t count, double *copy)
{
    for (int32_t k = 0; k < count; k++) copy[k] = values[k];
    return list_numbers(name, copy, count);
}

// Some kilobytes: all of it in one file.
static bool store_shape(const char *key, const Shape *shape, Error *err)
{
    char path[CACHE_PATH_SIZE];
    const Interface *interface = &shape->interface;
    int32_t contact = interface->contact_count, rod = interface->rod_count, m = interface->count;
    double counts[COUNTS] = {contact, rod, interface->pad_count, interface->gap ? contact : 0,
                             interface->dim},
           basis[BASIS_NUMBERS] = {0};
    int64_t names = (int64_t)interface->pad_count * NAME_NUMBERS;
    memcpy(basis, shape->basis, HASH_TEXT_SIZE);
    double *copy = NEW_ARRAY(double, 2 * contact + rod + m + names, err), *name_copy;
    if (!copy || !cache_file_path(key, "shape", path)) goto cleanup;
    name_copy = copy + 2 * contact + rod + m;
    if (interface->pad_name) memcpy(name_copy, interface->pad_name, (size_t)names * sizeof(double));
    CacheArray arrays[] = {
        list_numbers("counts", counts, COUNTS),
        list_numbers("sizes", &shape->sizes.length, sizeof(ShapeSizes) / sizeof(double)),
        list_numbers("basis", basis, BASIS_NUMBERS),
        list_indices("node", interface->node, contact, copy),
        list_numbers("x", interface->x, contact),
        list_numbers("weight", interface->weight, contact),
        list_numbers("gap", interface->gap, interface->gap ? contact : 0),
        list_indices("pad", interface->pad, contact, copy + contact),
        list_numbers("pad_name", name_copy, names),
        list_indices("rod_node", interface->rod_node, rod, copy + 2 * contact),
        list_numbers("rod_z", interface->rod_z, rod),
        list_numbers("rod_share", interface->rod_share, rod),
        list_numbers("rod_face", interface->rod_face, 2),
        list_indices("dofs", interface->dofs, m, copy + 2 * contact + rod),
        list_numbers("rotation", shape->rotation, m)};
    TRY(cache_file_write(path, key, arrays, sizeof arrays / sizeof *arrays, err));
cleanup:
    memory_free(copy);
    return error_is_clean(err);
}

void shape_cache_store(const char *key, const Shape *shape, char note[CACHE_NOTE_SIZE])
{
    Error err = {0};
    if (key[0] && !store_shape(key, shape, &err))
        snprintf(note, CACHE_NOTE_SIZE, "the shape is not kept for the next run: %.180s",
                 err.message);
}
